#include "strategies/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"

namespace keyhole {
namespace {

// A TOML string on one line.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            (result += '\\') += c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            result += c;
    }
    return result + '"';
}

// TOML tells numbers from integers by a point or an exponent, or by being inf or nan.
std::string number_text(double value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string found_text(const Value& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
    if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    return fmt::format("{}", std::get<std::int64_t>(value));
}

[[noreturn]] void refuse(const Parameter& parameter, const Value& value) {
    std::string hint;
    const auto* text = std::get_if<std::string>(&value);
    if (text && parameter.type == Parameter::Type::choice) hint = valid_names(*text, parameter.choices);
    throw InputError({}, fmt::format("'{}' cannot be {}; {}", parameter.name, found_text(value),
                                     hint.empty() ? "valid: " + valid_values(parameter) : hint));
}

}  // namespace

Parameter Parameter::number(std::string name, double fallback, double min, double max, std::string description) {
    Parameter p;
    p.name = std::move(name);
    p.description = std::move(description);
    p.fallback = fallback;
    p.min = min;
    p.max = max;
    return p;
}

Parameter Parameter::integer(std::string name, std::int64_t fallback, std::int64_t min, std::int64_t max,
                             std::string description) {
    Parameter p =
        number(std::move(name), 0, static_cast<double>(min), static_cast<double>(max), std::move(description));
    p.type = Type::integer;
    p.fallback = fallback;
    return p;
}

Parameter Parameter::choice(std::string name, std::vector<std::string> choices, std::string description) {
    Parameter p = text(std::move(name), std::move(description));
    p.type = Type::choice;
    p.fallback = choices.front();
    p.choices = std::move(choices);
    return p;
}

Parameter Parameter::text(std::string name, std::string description) {
    Parameter p = number(std::move(name), 0, 0, 0, std::move(description));
    p.type = Type::text;
    p.fallback = std::string();
    return p;
}

Parameter Parameter::of_step() const {
    Parameter p = *this;
    p.step_size = true;
    return p;
}

Parameter Parameter::open() const {
    Parameter p = *this;
    p.above = true;
    return p;
}

Parameter Parameter::in(std::string unit_name) const {
    Parameter p = *this;
    p.unit = std::move(unit_name);
    return p;
}

Parameter Parameter::or_word(std::string replacement) const {
    Parameter p = *this;
    p.word = std::move(replacement);
    return p;
}

Parameter Parameter::only_with(std::string other, std::string value) const {
    Parameter p = *this;
    p.needs = std::move(other);
    p.needed_value = std::move(value);
    return p;
}

Value checked(const Parameter& parameter, const Value& value) {
    using Type = Parameter::Type;
    switch (parameter.type) {
        case Type::number: {
            const auto* integer = std::get_if<std::int64_t>(&value);
            const auto* number = std::get_if<double>(&value);
            if (!integer && !number) break;
            const double x = integer ? static_cast<double>(*integer) : *number;
            if (!std::isfinite(x) || x > parameter.max || x < parameter.min || (parameter.above && x <= parameter.min))
                break;
            return x;
        }
        case Type::integer: {
            const auto* word = std::get_if<std::string>(&value);
            if (word && !parameter.word.empty() && *word == parameter.word) return std::int64_t{0};
            const auto* integer = std::get_if<std::int64_t>(&value);
            // The bounds are integers below 2^53, or 2^63, which is above every integer.
            if (!integer || *integer < static_cast<std::int64_t>(parameter.min) ||
                static_cast<double>(*integer) > parameter.max)
                break;
            return *integer;
        }
        case Type::boolean:
            if (std::holds_alternative<bool>(value)) return value;
            break;
        case Type::choice: {
            const auto* text = std::get_if<std::string>(&value);
            if (text && std::find(parameter.choices.begin(), parameter.choices.end(), *text) != parameter.choices.end())
                return value;
            break;
        }
        case Type::text:
            if (std::holds_alternative<std::string>(value)) return value;
    }
    refuse(parameter, value);
}

Value value_from_text(const Parameter& parameter, const std::string& text) {
    using Type = Parameter::Type;
    const bool is_number = parameter.type == Type::number || parameter.type == Type::integer;
    const bool is_word = !parameter.word.empty() && text == parameter.word;
    if (is_number && !is_word) {
        try {
            if (parameter.type == Type::integer) return checked(parameter, parse_integer(text, INT64_MIN, INT64_MAX));
            return checked(parameter, parse_real(text, -INFINITY, INFINITY));
        } catch (const InputError&) {
            throw InputError({}, fmt::format("'{}' is not valid here; valid: {}", text, valid_values(parameter)));
        }
    }
    if (parameter.type == Type::boolean && (text == "true" || text == "false")) return text == "true";
    return checked(parameter, text);
}

std::string to_toml(const Parameter& parameter, const Value& value) {
    if (!parameter.word.empty() && value == Value(std::int64_t{0})) return quoted(parameter.word);
    return found_text(value);
}

std::string valid_values(const Parameter& parameter) {
    using Type = Parameter::Type;
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    const std::string from = fmt::format("{} {}", parameter.above ? "above" : "from", parameter.min);
    switch (parameter.type) {
        case Type::number:
            return parameter.max < std::numeric_limits<double>::max()
                       ? fmt::format("a number {} to {}{}", from, parameter.max, unit)
                       : fmt::format("a number {} {}{}", parameter.above ? "above" : "of at least", parameter.min,
                                     unit);
        case Type::integer: {
            const std::string range =
                parameter.max >= 0x1p63
                    ? fmt::format("an integer of at least {}{}", parameter.min, unit)
                    : fmt::format("an integer from {} to {:.0f}{}", parameter.min, parameter.max, unit);
            return parameter.word.empty() ? range : range + " or " + quoted(parameter.word);
        }
        case Type::boolean:
            return "true or false";
        case Type::text:
            return "a text in quotes";
        case Type::choice:
            break;
    }
    std::string text;
    for (const std::string& choice : parameter.choices) text += (text.empty() ? "" : ", ") + quoted(choice);
    return text;
}

bool has_effect(const Parameter& parameter, const Values& values) {
    return parameter.needs.empty() || values.at(parameter.needs) == Value(parameter.needed_value);
}

}  // namespace keyhole
