#include "scene/reader/names.h"

#include <cctype>
#include <map>

namespace keyhole {
namespace {

bool upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// A word starts at a capital after a small letter or digit, and at the last of several capitals before a small letter.
std::string snake_case(const std::string& name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (upper(name[i]) && i > 0 && name[i - 1] != '_') {
            const bool next_is_small = i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1]));
            if (!upper(name[i - 1]) || next_is_small) out += '_';
        }
        out += lower(name[i]);
    }
    return out;
}

// What no change of case gives.
const std::map<std::string, std::string> renamed = {
    {"vflip", "flip_tex_coords"},
    {"flip_uvs", "flip_tex_coords"},
};

}  // namespace

std::string canonical_parameter(const std::string& name) {
    const std::string snake = snake_case(name);
    const auto found = renamed.find(snake);
    return found == renamed.end() ? snake : found->second;
}

std::string canonical_tag(const std::string& tag) { return tag == "lookAt" ? "lookat" : tag; }

}  // namespace keyhole
