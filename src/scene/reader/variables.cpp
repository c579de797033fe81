#include "scene/reader/variables.h"

#include <cctype>

#include "scene/reader/xml.h"

namespace keyhole {
namespace {

constexpr std::size_t max_length = 1 << 20;  // variables that double one another would fill the memory

template <class Map>
std::vector<std::string> keys(const Map& map) {
    std::vector<std::string> names;
    for (const auto& [name, value] : map) names.push_back(name);
    return names;
}

bool is_name_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

}  // namespace

void Variables::set_default(const std::string& name, const std::string& value, const SourceLocation& where) {
    const auto [first, inserted] = defaults_.emplace(name, where);
    if (!inserted && first->second.file == where.file)
        throw InputError(where, "the default '" + name + "' is given twice; first at " + place_text(first->second));
    values_.emplace(name, value);
}

std::string Variables::substitute(const std::string& text, const SourceLocation& where) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] != '$') {
            out += text[i++];
            continue;
        }
        std::size_t end = ++i;
        while (end < text.size() && is_name_character(text[end])) ++end;
        const std::string name = text.substr(i, end - i);
        const auto value = values_.find(name);
        if (value == values_.end())
            throw InputError(where, "unresolved variable '$" + name + "'; " + valid_names(name, keys(values_)));
        used_.insert(name);
        out += value->second;
        if (out.size() > max_length)
            throw InputError(where,
                             "the variable '$" + name + "' grows beyond " + std::to_string(max_length) + " characters");
        i = end;
    }
    return out;
}

void Variables::check_defines(const SourceLocation& scene) const {
    for (const auto& [name, value] : defines_)
        if (!defaults_.contains(name) && !used_.contains(name))
            throw InputError({scene.file, 0, 0}, "-D " + name + "=" + value +
                                                     " defines a variable that the scene does not have; " +
                                                     valid_names(name, keys(defaults_)));
}

std::vector<std::string> Variables::unused() const {
    std::vector<std::string> names;
    for (const auto& [name, where] : defaults_)
        if (!used_.contains(name)) names.push_back("default '" + name + "' (" + place_text(where) + ")");
    return names;
}

}  // namespace keyhole
