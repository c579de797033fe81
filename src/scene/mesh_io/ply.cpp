#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "scene/mesh_io.h"
#include "scene/mesh_io/file_text.h"
#include "scene/mesh_io/ply_header.h"

namespace keyhole {
namespace {

// The values of a PLY file one after the other, whatever they are stored as. A double holds all of them exactly.
class ValueReader {
  public:
    ValueReader(const std::string& filename, std::string_view text, const PlyHeader& header)
        : filename_(filename), text_(text), position_(header.bytes), format_(header.format) {}

    double next(PlyType type) { return format_ == PlyFormat::ascii ? next_ascii() : next_binary(type); }

    std::size_t bytes_left() const { return text_.size() - position_; }
    bool at_end() {
        if (format_ == PlyFormat::ascii) skip_space();
        return bytes_left() == 0;
    }

    [[noreturn]] void fail(const std::string& message) const {
        if (format_ != PlyFormat::ascii) {
            throw InputError({filename_}, message + " (before byte " + std::to_string(position_) + ")");
        }
        SourceLocation where = locate(filename_, text_, last_);
        throw InputError(where, message);
    }

  private:
    void skip_space() {
        while (position_ < text_.size() && std::strchr(" \t\r\n", text_[position_]) && text_[position_]) ++position_;
    }

    double next_ascii() {
        skip_space();
        last_ = position_;
        if (position_ == text_.size()) fail("truncated: the file ends before its last element");
        if (text_[position_] == '+') ++position_;
        double value = 0;
        const char* end = text_.data() + text_.size();
        const auto [stop, error] = std::from_chars(text_.data() + position_, end, value);
        const bool ends = stop == end || std::strchr(" \t\r\n", *stop);
        if (error == std::errc::result_out_of_range) fail("a number is out of range");
        if (error != std::errc() || !ends) fail("expected a number");
        position_ = static_cast<std::size_t>(stop - text_.data());
        return value;
    }

    double next_binary(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t, std::uint8_t>();
            case PlyType::uint8:
                return take<std::uint8_t, std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t, std::uint16_t>();
            case PlyType::uint16:
                return take<std::uint16_t, std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t, std::uint32_t>();
            case PlyType::uint32:
                return take<std::uint32_t, std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(take<float, std::uint32_t>());
            case PlyType::float64:
                return take<double, std::uint64_t>();
        }
        return 0;
    }

    template <class T, class Bits>
    T take() {
        if (bytes_left() < sizeof(Bits)) fail("truncated: the file ends before its last element");
        Bits bits = 0;
        const bool little = format_ == PlyFormat::binary_little_endian;
        for (std::size_t i = 0; i < sizeof(Bits); ++i) {
            const auto byte = static_cast<unsigned char>(text_[position_ + i]);
            const std::size_t shift = 8 * (little ? i : sizeof(Bits) - 1 - i);
            bits = static_cast<Bits>(bits | static_cast<Bits>(Bits{byte} << shift));
        }
        position_ += sizeof(Bits);
        return std::bit_cast<T>(bits);
    }

    const std::string& filename_;
    std::string_view text_;
    std::size_t position_;
    std::size_t last_ = 0;  // where the last ASCII value began
    PlyFormat format_;
};

// The columns of the vertex element that make one attribute; empty if the file has none.
std::vector<int> columns(const std::string& filename, const PlyElement& element,
                         std::initializer_list<const char*> names) {
    std::vector<int> found;
    for (const char* name : names) {
        const int column = element.find(name);
        if (column < 0) continue;
        if (element.properties[static_cast<std::size_t>(column)].is_list) {
            throw InputError({filename}, std::string("the vertex property '") + name + "' must not be a list");
        }
        found.push_back(column);
    }
    if (!found.empty() && found.size() != names.size()) {
        throw InputError({filename}, std::string("vertices have some, but not all of the properties ") +
                                         *names.begin() + " to " + *(names.end() - 1));
    }
    return found;
}

class PlyReader {
  public:
    explicit PlyReader(const std::string& filename)
        : filename_(filename),
          text_(read_whole_file(filename)),
          header_(read_ply_header(filename, text_)),
          values_(filename, text_, header_) {}

    std::shared_ptr<Mesh> read() {
        bool has_vertices = false, has_faces = false;
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                read_vertices(element);
                has_vertices = true;
            } else if (element.name == "face") {
                read_faces(element);
                has_faces = true;
            } else {
                for (std::size_t i = 0; i < element.count; ++i) read_row(element, -1);
            }
        }
        if (!has_vertices || !has_faces) throw InputError({filename_}, "the file has no 'vertex' or no 'face' element");
        if (!values_.at_end()) values_.fail("data after the last element");
        check_read_mesh(*mesh_, filename_);
        return mesh_;
    }

  private:
    // One element: its scalars go to row_, the list at column `list` to list_; other lists are skipped.
    void read_row(const PlyElement& element, int list) {
        row_.assign(element.properties.size(), 0);
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (!property.is_list) {
                row_[i] = values_.next(property.type);
                continue;
            }
            const double length = values_.next(property.count_type);
            if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(values_.bytes_left())) {
                values_.fail("the length of the list '" + property.name + "' is not valid");
            }
            const bool keep = static_cast<int>(i) == list;
            if (keep) list_.clear();
            for (auto n = static_cast<std::size_t>(length); n > 0; --n) {
                const double value = values_.next(property.type);
                if (keep) list_.push_back(value);
            }
        }
    }

    float cell(int column) const { return static_cast<float>(row_[static_cast<std::size_t>(column)]); }

    void read_vertices(const PlyElement& element) {
        const std::vector<int> p = columns(filename_, element, {"x", "y", "z"});
        const std::vector<int> n = columns(filename_, element, {"nx", "ny", "nz"});
        std::vector<int> uv = columns(filename_, element, {"u", "v"});
        if (uv.empty()) uv = columns(filename_, element, {"s", "t"});
        if (uv.empty()) uv = columns(filename_, element, {"texture_u", "texture_v"});
        if (p.empty()) throw InputError({filename_}, "vertices have no x, y and z");
        reserve_positions(*mesh_, element.count);
        if (!n.empty()) mesh_->normals.reserve(element.count);
        if (!uv.empty()) mesh_->uvs.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            read_row(element, -1);
            mesh_->positions.emplace_back(cell(p[0]), cell(p[1]), cell(p[2]));
            bool finite = mesh_->positions.back().allFinite();
            if (!n.empty()) {
                mesh_->normals.emplace_back(cell(n[0]), cell(n[1]), cell(n[2]));
                finite &= mesh_->normals.back().allFinite();
            }
            if (!uv.empty()) {
                mesh_->uvs.emplace_back(cell(uv[0]), cell(uv[1]));
                finite &= mesh_->uvs.back().allFinite();
            }
            if (!finite) values_.fail("a value of vertex " + std::to_string(i) + " is not finite");
        }
    }

    void read_faces(const PlyElement& element) {
        int list = element.find("vertex_indices");
        if (list < 0) list = element.find("vertex_index");
        if (list < 0 || !element.properties[static_cast<std::size_t>(list)].is_list) {
            throw InputError({filename_}, "faces have no list 'vertex_indices'");
        }
        mesh_->triangles.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            read_row(element, list);
            if (list_.size() < 3) values_.fail("face " + std::to_string(i) + " has fewer than 3 corners");
            for (std::size_t k = 2; k < list_.size(); ++k) {
                mesh_->triangles.push_back({index(list_[0]), index(list_[k - 1]), index(list_[k])});
            }
        }
    }

    std::uint32_t index(double value) const {
        if (!(value >= 0 && value <= std::numeric_limits<std::uint32_t>::max()) || value != std::floor(value)) {
            values_.fail("a vertex index is out of range");
        }
        return static_cast<std::uint32_t>(value);
    }

    const std::string& filename_;
    std::string text_;
    PlyHeader header_;
    ValueReader values_;
    std::vector<double> row_, list_;
    std::shared_ptr<Mesh> mesh_ = std::make_shared<Mesh>();
};

}  // namespace

std::shared_ptr<Mesh> read_ply(const std::string& filename) { return PlyReader(filename).read(); }

}  // namespace keyhole
