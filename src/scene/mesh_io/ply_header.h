// The header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t ply_size(PlyType type);

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  // lists only
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    int find(std::string_view property) const;  // index, or -1
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0;  // where the data begin
};

// Throws InputError with the line for what is not a valid header, and for counts that the file is too short for.
PlyHeader read_ply_header(const std::string& filename, std::string_view text);

}  // namespace keyhole
