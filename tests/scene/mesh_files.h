// Writes mesh files for the tests of the readers.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/mesh_io.h"

namespace keyhole {

// A file of this test program's own, removed at the end.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("keyhole_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "_" + name)) {}
    TemporaryFile(const std::string& name, const std::string& bytes) : TemporaryFile(name) { write(bytes); }
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(const std::string& bytes) const {
        std::ofstream file(path_, std::ios::binary | std::ios::trunc);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!file) throw std::runtime_error("cannot write " + path_.string());
    }
    std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

// Two triangles of a unit square with normals and uv, of values that all formats hold exactly.
inline Mesh square_mesh() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0.5F}, {1, 0, 0.5F}, {1, 1, 0.5F}, {0, 1, 0.25F}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0.5F, 0, 1}, {0, -0.25F, 1}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

enum class PlyEncoding { ascii, little, big };

inline std::string ply_file(const Mesh& mesh, PlyEncoding encoding) {
    const char* formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string file = std::string("ply\nformat ") + formats[static_cast<int>(encoding)] + " 1.0\ncomment by hand\n";
    file += "element vertex " + std::to_string(mesh.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
        file += std::string("property float ") + name + "\n";
    file += "property uchar quality\nelement face " + std::to_string(mesh.triangles.size());
    file += "\nproperty list uchar int vertex_indices\nend_header\n";
    const bool ascii = encoding == PlyEncoding::ascii, big = encoding == PlyEncoding::big;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3f &p = mesh.positions[i], &n = mesh.normals[i];
        for (const float value : {p[0], p[1], p[2], n[0], n[1], n[2], mesh.uvs[i][0], mesh.uvs[i][1]}) {
            if (ascii) {
                file += std::to_string(value) + " ";
            } else {
                append(file, value, big);
            }
        }
        file += ascii ? "7\n" : "\x07";
    }
    for (const auto& triangle : mesh.triangles) {
        file += ascii ? "3" : "\x03";
        for (const std::uint32_t index : triangle) {
            if (ascii) {
                file += " " + std::to_string(index);
            } else {
                append(file, index, big);
            }
        }
        if (ascii) file += "\n";
    }
    return file;
}

inline std::string obj_file(const Mesh& mesh) {
    std::string file = "# by hand\nmtllib none.mtl\no square\n";
    const auto add = [&](const char* keyword, const auto& values) {
        for (const auto& v : values) {
            file += keyword;
            for (int k = 0; k < v.size(); ++k) file += " " + std::to_string(v[k]);
            file += "\n";
        }
    };
    add("v", mesh.positions);
    add("vt", mesh.uvs);
    add("vn", mesh.normals);
    file += "usemtl grey\ns 1\n";
    for (const auto& triangle : mesh.triangles) {
        file += "f";
        for (const std::uint32_t index : triangle) {
            const std::string i = std::to_string(index + 1);
            file += " " + i + "/" + i + "/" + i;
        }
        file += "\n";
    }
    return file;
}

inline std::string deflated(const std::string& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             static_cast<uLong>(bytes.size()));
    out.resize(size);
    return out;
}

// The bytes of one mesh of a .serialized file before compression.
inline std::string serialized_body(const Mesh& mesh, int version, bool doubles, std::uint32_t extra_flags = 0) {
    std::string body;
    append<std::uint32_t>(body, (doubles ? 0x2000U : 0x1000U) | (mesh.normals.empty() ? 0U : 1U) |
                                    (mesh.uvs.empty() ? 0U : 2U) | extra_flags);
    if (version == 4) body += std::string("name") + '\0';
    append<std::uint64_t>(body, mesh.positions.size());
    append<std::uint64_t>(body, mesh.triangles.size());
    const auto add = [&](const auto& values) {
        for (const auto& v : values) {
            for (int k = 0; k < v.size(); ++k) doubles ? append<double>(body, v[k]) : append<float>(body, v[k]);
        }
    };
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.uvs);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) append(body, index);
    }
    return body;
}

inline std::string serialized_file(const std::vector<std::string>& bodies, int version) {
    std::string file;
    std::vector<std::size_t> offsets;
    for (const std::string& body : bodies) {
        offsets.push_back(file.size());
        append<std::uint16_t>(file, 0x041C);
        append(file, static_cast<std::uint16_t>(version));
        file += deflated(body);
    }
    for (const std::size_t offset : offsets) {
        if (version == 4) {
            append<std::uint64_t>(file, offset);
        } else {
            append(file, static_cast<std::uint32_t>(offset));
        }
    }
    append(file, static_cast<std::uint32_t>(bodies.size()));
    return file;
}

}  // namespace keyhole
