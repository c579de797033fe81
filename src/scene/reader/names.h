// Names of the two dialects: the reader knows only those of Mitsuba 3 (snake_case).
#pragma once

#include <string>

namespace keyhole {

// The Mitsuba 3 spelling of a parameter's name: toWorld -> to_world, intIOR -> int_ior; true renames come from a table.
std::string canonical_parameter(const std::string& name);

// The same for elements: lookAt -> lookat.
std::string canonical_tag(const std::string& tag);

}  // namespace keyhole
