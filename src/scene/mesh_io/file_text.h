// What all readers of mesh files share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/error.h"
#include "scene/shape.h"

namespace keyhole {

// The whole file. Throws InputError.
std::string read_whole_file(const std::string& filename);

// Where byte `offset` of a text file is. Lines end with \n, \r\n or \r.
SourceLocation locate(const std::string& filename, std::string_view text, std::size_t offset);

// Room for one more position than the mesh has: Embree reads 16 bytes at the last one.
void reserve_positions(Mesh& mesh, std::size_t n);

// check_mesh, as an InputError of the file.
void check_read_mesh(const Mesh& mesh, const std::string& filename);

}  // namespace keyhole
