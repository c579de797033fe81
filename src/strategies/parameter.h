// What a key of a mix file may hold. Each key is described once, and read, checked, written and documented from that.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace keyhole {

using Value = std::variant<bool, std::int64_t, double, std::string>;
using Values = std::map<std::string, Value>;  // by the parameter's name

struct Parameter {
    enum class Type { number, integer, boolean, choice, text };

    std::string name;         // kebab-case
    std::string description;  // a phrase, for the documentation
    Type type = Type::number;
    Value fallback;  // what it is where the file does not say

    // Numbers and integers: in [min, max], or (min, max] with `above`.
    double min = 0, max = 0;
    bool above = false;
    std::string unit;
    std::string word;                  // integers: what may stand there for "as the program chooses"; read as 0
    std::vector<std::string> choices;  // of a choice

    // Has an effect only where the other parameter, a choice, is `needed_value`; empty: always.
    std::string needs, needed_value;

    static Parameter number(std::string name, double fallback, double min, double max, std::string description);
    static Parameter integer(std::string name, std::int64_t fallback, std::int64_t min, std::int64_t max,
                             std::string description);
    static Parameter choice(std::string name, std::vector<std::string> choices,
                            std::string description);  // first: default
    static Parameter text(std::string name, std::string description);

    bool step_size = false;  // tuning scales all such of a strategy together

    // Copies with one more property, for chains of calls in the registry.
    Parameter of_step() const;
    Parameter open() const;
    Parameter in(std::string unit_name) const;
    Parameter or_word(std::string replacement) const;
    Parameter only_with(std::string other, std::string value) const;
};

// The value as this parameter holds it (an integer where a number may stand becomes a number). Throws InputError
// (without a location) that says what would have been valid.
Value checked(const Parameter& parameter, const Value& value);

// The same from text of the command line, where strings have no quotes.
Value value_from_text(const Parameter& parameter, const std::string& text);

// As a mix file has it: numbers in the fewest digits that read back as the same number, strings in quotes.
std::string to_toml(const Parameter& parameter, const Value& value);

// "a number above 0 to 0.5", "\"kelemen\" or \"gaussian\"".
std::string valid_values(const Parameter& parameter);

// The value of a number, and whether a choice has the value, among values that hold all parameters.
inline double number(const Values& values, const char* name) { return std::get<double>(values.at(name)); }
inline bool is_choice(const Values& values, const char* name, const char* value) {
    return std::get<std::string>(values.at(name)) == value;
}

bool has_effect(const Parameter& parameter, const Values& values);

}  // namespace keyhole
