// Which build this is, for --version, reports and image metadata.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace keyhole {

std::string version();  // of Keyhole, "0.1.0"

// The versions of everything that takes part in a picture: keyhole, compiler, OpenImageIO, Embree.
nlohmann::ordered_json versions();

}  // namespace keyhole
