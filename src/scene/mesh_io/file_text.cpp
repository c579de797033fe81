#include "scene/mesh_io/file_text.h"

#include <fstream>
#include <stdexcept>

#include "scene/shapes/mesh_shape.h"

namespace keyhole {

std::string read_whole_file(const std::string& filename) {
    std::ifstream file(filename, std::ios::binary | std::ios::ate);
    const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
    std::string bytes;
    if (size >= 0) {
        bytes.resize(static_cast<std::size_t>(size));
        file.seekg(0);
        file.read(bytes.data(), size);
    }
    if (size < 0 || !file) throw InputError({filename}, "cannot read the file");
    return bytes;
}

SourceLocation locate(const std::string& filename, std::string_view text, std::size_t offset) {
    SourceLocation where{filename, 1, 1};
    for (std::size_t i = 0; i < offset && i < text.size(); ++i) {
        const bool line_ends = text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'));
        where.line += line_ends;
        where.column = line_ends ? 1 : where.column + 1;
    }
    return where;
}

void reserve_positions(Mesh& mesh, std::size_t n) { mesh.positions.reserve(n + 1); }

void check_read_mesh(const Mesh& mesh, const std::string& filename) {
    try {
        check_mesh(mesh);
    } catch (const std::invalid_argument& error) {
        throw InputError({filename}, error.what());
    }
}

}  // namespace keyhole
