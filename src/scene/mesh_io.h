// Mesh files. All throw InputError (with the line where the format has lines) for what cannot be read, indices out of
// range and values that are not finite. Faces with more than three corners are triangulated.
#pragma once

#include <memory>
#include <string>

#include "scene/shape.h"

namespace keyhole {

std::shared_ptr<Mesh> read_obj(const std::string& filename);
std::shared_ptr<Mesh> read_ply(const std::string& filename);                          // ascii and binary, both orders
std::shared_ptr<Mesh> read_serialized(const std::string& filename, int shape_index);  // Mitsuba 0.6, zlib

}  // namespace keyhole
