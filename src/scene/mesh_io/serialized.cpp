// Mitsuba 0.6's binary mesh format: little-endian meshes, each a header and a zlib stream, and a table of their
// offsets at the end of the file.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

#include "scene/mesh_io.h"
#include "scene/mesh_io/file_text.h"
#include "scene/mesh_io/inflate.h"

namespace keyhole {
namespace {

constexpr std::uint16_t magic = 0x041C;
constexpr std::uint32_t has_normals = 0x1, has_uvs = 0x2, has_colors = 0x8, face_normals = 0x10,
                        single_precision = 0x1000, double_precision = 0x2000;
constexpr std::size_t header_size = 4;  // magic and version, two bytes each

template <class T>
T value_at(const std::string& filename, std::string_view bytes, std::size_t offset) {
    if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) throw InputError({filename}, "truncated file");
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

std::uint16_t check_header(const std::string& filename, std::string_view bytes, std::size_t offset) {
    if (value_at<std::uint16_t>(filename, bytes, offset) != magic) {
        throw InputError({filename},
                         "not a serialized mesh (a wrong magic number at byte " + std::to_string(offset) + ")");
    }
    const auto version = value_at<std::uint16_t>(filename, bytes, offset + 2);
    if (version != 3 && version != 4) {
        throw InputError({filename}, "unknown version " + std::to_string(version) + "; valid are 3 and 4");
    }
    return version;
}

// The bytes of one mesh, header included.
std::string_view find_mesh(const std::string& filename, std::string_view bytes, int shape_index) {
    const std::uint16_t version = check_header(filename, bytes, 0);
    const std::size_t entry = version == 4 ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
    if (bytes.size() < header_size + sizeof(std::uint32_t)) throw InputError({filename}, "truncated file");
    const std::size_t count_at = bytes.size() - sizeof(std::uint32_t);
    const auto count = value_at<std::uint32_t>(filename, bytes, count_at);
    if (count == 0 || count > (count_at - header_size) / entry) {
        throw InputError({filename}, "the table of meshes at the end is damaged");
    }
    if (shape_index < 0 || static_cast<std::uint32_t>(shape_index) >= count) {
        throw InputError({filename}, "shape_index " + std::to_string(shape_index) + " is out of range, the file has " +
                                         std::to_string(count) + " meshes, numbered from 0");
    }
    const std::size_t table = count_at - count * entry;
    const auto offset_of = [&](std::uint32_t i) -> std::uint64_t {
        if (i == count) return table;
        if (version == 4) return value_at<std::uint64_t>(filename, bytes, table + i * entry);
        return value_at<std::uint32_t>(filename, bytes, table + i * entry);
    };
    const std::uint64_t begin = offset_of(static_cast<std::uint32_t>(shape_index));
    const std::uint64_t end = offset_of(static_cast<std::uint32_t>(shape_index) + 1);
    if (begin >= end || end > table || end - begin < header_size) {
        throw InputError({filename}, "the table of meshes at the end is damaged");
    }
    return bytes.substr(begin, end - begin);
}

// Appends n rows of N components each, in blocks: a damaged count ends with the data, not with the memory.
template <class Component, std::size_t N, class Row>
void read_rows(InflateReader& in, std::size_t n, std::vector<Row>& rows) {
    constexpr std::size_t block = 4096;
    std::vector<std::array<Component, N>> buffer(std::min(n, block));
    while (n > 0) {
        const std::size_t count = std::min(n, block);
        in.read(buffer.data(), count * sizeof(buffer[0]));
        for (std::size_t i = 0; i < count; ++i) {
            Row& row = rows.emplace_back();
            for (std::size_t k = 0; k < N; ++k)
                row[k] = static_cast<std::remove_reference_t<decltype(row[k])>>(buffer[i][k]);
        }
        n -= count;
    }
}

template <class Component>
void read_attributes(InflateReader& in, std::uint32_t flags, std::size_t n, Mesh& mesh) {
    read_rows<Component, 3>(in, n, mesh.positions);
    if (flags & has_normals) read_rows<Component, 3>(in, n, mesh.normals);
    if (flags & has_uvs) read_rows<Component, 2>(in, n, mesh.uvs);
    std::vector<Vec3f> unused_colors;
    if (flags & has_colors) read_rows<Component, 3>(in, n, unused_colors);
    if (flags & face_normals) mesh.normals.clear();
}

}  // namespace

std::shared_ptr<Mesh> read_serialized(const std::string& filename, int shape_index) {
    const std::string bytes = read_whole_file(filename);
    const std::string_view part = find_mesh(filename, bytes, shape_index);
    const std::uint16_t version = check_header(filename, part, 0);
    InflateReader in(filename, part.substr(header_size));
    const auto flags = in.read<std::uint32_t>();
    if (version == 4) {
        while (in.read<char>() != '\0') continue;  // the mesh's name
    }
    const auto vertices = in.read<std::uint64_t>(), triangles = in.read<std::uint64_t>();
    const bool doubles = (flags & double_precision) != 0;
    if (doubles == ((flags & single_precision) != 0)) {
        throw InputError({filename}, "the mesh's flags do not say whether it is of single or double precision");
    }
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
        throw InputError({filename}, "the mesh has more than 2^32 vertices");
    }
    auto mesh = std::make_shared<Mesh>();
    if (doubles) {
        read_attributes<double>(in, flags, vertices, *mesh);
    } else {
        read_attributes<float>(in, flags, vertices, *mesh);
    }
    read_rows<std::uint32_t, 3>(in, triangles, mesh->triangles);
    in.finish();
    reserve_positions(*mesh, mesh->positions.size());
    check_read_mesh(*mesh, filename);
    return mesh;
}

}  // namespace keyhole
