// Strictness that tinyobjloader lacks: it reads a malformed number as 0 and skips what it does not know.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace keyhole {

struct ObjCounts {
    std::size_t positions = 0, normals = 0, uvs = 0, faces = 0;
};

// Throws InputError with line and column for a statement that is unknown, a vertex that is not of (enough) numbers and
// a face that is not of three or more well-formed corners.
ObjCounts check_obj(const std::string& filename, std::string_view text);

}  // namespace keyhole
