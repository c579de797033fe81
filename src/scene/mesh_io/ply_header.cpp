#include "scene/mesh_io/ply_header.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "base/error.h"

namespace keyhole {
namespace {

struct TypeName {
    const char* name;
    PlyType type;
    std::size_t size;
};
constexpr TypeName type_names[] = {
    {"char", PlyType::int8, 1},       {"uchar", PlyType::uint8, 1},    {"short", PlyType::int16, 2},
    {"ushort", PlyType::uint16, 2},   {"int", PlyType::int32, 4},      {"uint", PlyType::uint32, 4},
    {"float", PlyType::float32, 4},   {"double", PlyType::float64, 8}, {"int8", PlyType::int8, 1},
    {"uint8", PlyType::uint8, 1},     {"int16", PlyType::int16, 2},    {"uint16", PlyType::uint16, 2},
    {"int32", PlyType::int32, 4},     {"uint32", PlyType::uint32, 4},  {"float32", PlyType::float32, 4},
    {"float64", PlyType::float64, 8},
};

class HeaderReader {
  public:
    HeaderReader(const std::string& filename, std::string_view text) : filename_(filename), text_(text) {}

    PlyHeader read() {
        if (next_line() != std::vector<std::string>{"ply"}) fail("not a PLY file: the first line is not 'ply'");
        bool has_format = false;
        for (;;) {
            const std::vector<std::string> words = next_line();
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format") {
                read_format(words);
                has_format = true;
            } else if (words[0] == "element") {
                read_element(words);
            } else if (words[0] == "property") {
                read_property(words);
            } else {
                fail("unknown header line; " +
                     valid_names(words[0], {"format", "element", "property", "comment", "obj_info", "end_header"}));
            }
        }
        if (!has_format) fail("the header has no 'format' line");
        header_.bytes = position_;
        check_sizes();
        return std::move(header_);
    }

  private:
    std::vector<std::string> next_line() {
        constexpr std::size_t longest = 4096;  // longer is not a header
        ++line_;
        const std::size_t end = text_.substr(0, std::min(text_.size(), position_ + longest)).find('\n', position_);
        if (end == std::string_view::npos) fail("the header ends without 'end_header'");
        std::vector<std::string> words;
        std::string word;
        for (const char c : text_.substr(position_, end + 1 - position_)) {
            if (c != ' ' && c != '\t' && c != '\r' && c != '\n') {
                word += c;
            } else if (!word.empty()) {
                words.push_back(std::exchange(word, {}));
            }
        }
        position_ = end + 1;
        return words;
    }

    void read_format(const std::vector<std::string>& words) {
        const std::vector<std::string> names = {"ascii", "binary_little_endian", "binary_big_endian"};
        const auto found = words.size() == 3 ? std::find(names.begin(), names.end(), words[1]) : names.end();
        if (found == names.end()) fail("unknown format; " + valid_names(words.size() > 1 ? words[1] : "", names));
        if (words[2] != "1.0") fail("unknown version '" + words[2] + "'; valid is 1.0");
        header_.format = static_cast<PlyFormat>(found - names.begin());
    }

    void read_element(const std::vector<std::string>& words) {
        PlyElement element;
        if (words.size() != 3) fail("expected 'element NAME COUNT'");
        const char* end = words[2].data() + words[2].size();
        const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
        if (error != std::errc() || stop != end) fail("'" + words[2] + "' is not a number of elements");
        element.name = words[1];
        header_.elements.push_back(std::move(element));
    }

    void read_property(const std::vector<std::string>& words) {
        if (header_.elements.empty()) fail("a property before the first element");
        PlyProperty property;
        property.is_list = words.size() > 1 && words[1] == "list";
        if (words.size() != (property.is_list ? 5 : 3))
            fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        if (property.is_list) {
            property.count_type = type(words[2]);
            if (property.count_type >= PlyType::float32) fail("the length of a list must be an integer");
        }
        property.type = type(words[words.size() - 2]);
        property.name = words.back();
        PlyElement& element = header_.elements.back();
        if (element.find(property.name) >= 0) fail("the property '" + property.name + "' is given twice");
        element.properties.push_back(std::move(property));
    }

    PlyType type(const std::string& name) const {
        std::vector<std::string> names;
        for (const TypeName& t : type_names) {
            if (name == t.name) return t.type;
            names.push_back(t.name);
        }
        fail("unknown type '" + name + "'; " + valid_names(name, names));
    }

    // Before anything is allocated: each element takes at least so many bytes.
    void check_sizes() const {
        std::size_t left = text_.size() - position_;
        for (const PlyElement& element : header_.elements) {
            std::size_t least = 0;
            for (const PlyProperty& p : element.properties) {
                if (header_.format == PlyFormat::ascii) {
                    least += 2;
                } else {
                    least += ply_size(p.is_list ? p.count_type : p.type);
                }
            }
            if (element.count == 0) continue;
            if (least == 0) throw InputError({filename_}, "the element '" + element.name + "' has no properties");
            // The last number of an ASCII file needs no space after it.
            if (element.count > (left + 1) / least) {
                throw InputError({filename_}, "truncated: the file is too short for " + std::to_string(element.count) +
                                                  " elements '" + element.name + "'");
            }
            left -= std::min(left, element.count * least);
        }
    }

    [[noreturn]] void fail(const std::string& message) const { throw InputError({filename_, line_, 0}, message); }

    const std::string& filename_;
    std::string_view text_;
    std::size_t position_ = 0;
    int line_ = 0;
    PlyHeader header_;
};

}  // namespace

std::size_t ply_size(PlyType type) {
    return std::find_if(std::begin(type_names), std::end(type_names), [&](auto& t) { return t.type == type; })->size;
}

int PlyElement::find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == property) return static_cast<int>(i);
    }
    return -1;
}

PlyHeader read_ply_header(const std::string& filename, std::string_view text) {
    return HeaderReader(filename, text).read();
}

}  // namespace keyhole
