#include "scene/mesh_io/obj_check.h"

#include <algorithm>
#include <array>

#include "scene/mesh_io/file_text.h"

namespace keyhole {
namespace {

// Grouping, materials and display attributes do not change the surface. Free-form curves and surfaces would.
constexpr std::array<std::string_view, 16> ignored_statements = {
    "g",  "o",   "s",      "usemtl", "mtllib", "l",        "p",        "vp",
    "mg", "lod", "usemap", "maplib", "bevel",  "c_interp", "d_interp", "shadow_obj"};

constexpr std::size_t max_index_digits = 9;     // below 2^31
constexpr std::size_t max_exponent_digits = 4;  // beyond, tinyobjloader gives up

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

// Reads one line; the position only moves forward.
class LineChecker {
  public:
    LineChecker(const std::string& filename, std::string_view text) : filename_(filename), text_(text) {}

    bool at_end() const { return position_ == text_.size(); }

    void check_line(ObjCounts& counts) {
        const std::string_view keyword = token();
        if (keyword.empty() || keyword[0] == '#') {
            skip_line();
        } else if (keyword == "v") {
            check_numbers("a vertex", 3);
            ++counts.positions;
        } else if (keyword == "vn") {
            check_numbers("a normal", 3);
            ++counts.normals;
        } else if (keyword == "vt") {
            check_numbers("a texture coordinate", 1);
            ++counts.uvs;
        } else if (keyword == "f") {
            check_face();
            ++counts.faces;
        } else if (std::find(ignored_statements.begin(), ignored_statements.end(), keyword) !=
                   ignored_statements.end()) {
            skip_line();
        } else {
            fail(keyword, "unknown statement '" + printable(keyword) + "'; valid are v, vn, vt, f and grouping");
        }
        if (!at_end()) ++position_;
    }

  private:
    // The next token of the line, empty at its end.
    std::string_view token() {
        while (!at_end() && is_blank(text_[position_])) ++position_;
        const std::size_t begin = position_;
        while (!at_end() && !is_blank(text_[position_]) && !is_line_end(text_[position_])) ++position_;
        return text_.substr(begin, position_ - begin);
    }

    void skip_line() {
        while (!at_end() && !is_line_end(text_[position_])) ++position_;
    }

    static std::size_t digits(std::string_view s, std::size_t& i) {
        const std::size_t begin = i;
        while (i < s.size() && is_digit(s[i])) ++i;
        return i - begin;
    }

    // [sign] digits [. digits] [e [sign] digits], with digits on at least one side of the point.
    static bool is_number(std::string_view s) {
        std::size_t i = 0;
        if (i < s.size() && (s[i] == '+' || s[i] == '-')) ++i;
        std::size_t mantissa = digits(s, i);
        if (i < s.size() && s[i] == '.') mantissa += digits(s, ++i);
        if (mantissa == 0) return false;
        if (i == s.size()) return true;
        if (s[i] != 'e' && s[i] != 'E') return false;
        ++i;
        if (i < s.size() && (s[i] == '+' || s[i] == '-')) ++i;
        const std::size_t exponent = digits(s, i);
        return exponent > 0 && exponent <= max_exponent_digits && i == s.size();
    }

    void check_numbers(const char* what, int least) {
        int count = 0;
        for (std::string_view s = token(); !s.empty(); s = token()) {
            if (!is_number(s)) fail(s, "'" + printable(s) + "' is not a number");
            ++count;
        }
        if (count < least) {
            fail(text_.substr(position_, 0),
                 std::string(what) + " needs " + std::to_string(least) + " numbers, found " + std::to_string(count));
        }
    }

    // An index: [-] digits, not zero.
    static bool is_index(std::string_view s) {
        std::size_t i = !s.empty() && s[0] == '-' ? 1 : 0;
        const std::size_t n = digits(s, i);
        return n > 0 && n <= max_index_digits && i == s.size() && s.find_first_not_of("-0") != std::string_view::npos;
    }

    // v, v/vt, v//vn or v/vt/vn.
    static bool is_corner(std::string_view s) {
        const std::size_t first = s.find('/');
        if (!is_index(s.substr(0, first))) return false;
        if (first == std::string_view::npos) return true;
        s.remove_prefix(first + 1);
        const std::size_t second = s.find('/');
        const std::string_view uv = s.substr(0, second);
        if (second == std::string_view::npos) return is_index(uv);
        return (uv.empty() || is_index(uv)) && is_index(s.substr(second + 1));
    }

    void check_face() {
        int corners = 0;
        for (std::string_view s = token(); !s.empty(); s = token()) {
            if (!is_corner(s)) fail(s, "'" + printable(s) + "' is not a face corner (v, v/vt, v//vn or v/vt/vn)");
            ++corners;
        }
        if (corners < 3) {
            fail(text_.substr(position_, 0), "a face needs 3 corners, found " + std::to_string(corners));
        }
    }

    static std::string printable(std::string_view s) {
        std::string result(s.substr(0, 40));
        for (char& c : result) {
            if (c < ' ' || c > '~') c = '?';
        }
        return result;
    }

    [[noreturn]] void fail(std::string_view at, const std::string& message) const {
        throw InputError(locate(filename_, text_, static_cast<std::size_t>(at.data() - text_.data())), message);
    }

    const std::string& filename_;
    std::string_view text_;
    std::size_t position_ = 0;
};

}  // namespace

ObjCounts check_obj(const std::string& filename, std::string_view text) {
    ObjCounts counts;
    LineChecker checker(filename, text);
    while (!checker.at_end()) checker.check_line(counts);
    return counts;
}

}  // namespace keyhole
