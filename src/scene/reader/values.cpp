#include "scene/reader/values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace keyhole {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

[[noreturn]] void fail(const SourceLocation& where, const std::string& what, std::string_view text, const char* why) {
    throw InputError(where, fmt::format("{}: '{}' {}", what, text, why));
}

template <class Number>
Number parse(std::string_view text, const SourceLocation& where, const std::string& what, const char* not_a_number) {
    Number value{};
    const char* first = text.data();
    const char* last = first + text.size();
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error == std::errc::result_out_of_range) fail(where, what, text, "is out of range");
    if (error != std::errc{} || end != last) fail(where, what, text, not_a_number);
    return value;
}

double parse_finite(std::string_view text, const SourceLocation& where, const std::string& what) {
    const double value = parse<double>(text, where, what, "is not a number");
    if (!std::isfinite(value)) fail(where, what, text, "is not a finite number");
    return value;
}

}  // namespace

double parse_number(const std::string& text, const SourceLocation& where, const std::string& what) {
    return parse_finite(trimmed(text), where, what);
}

int parse_integer(const std::string& text, const SourceLocation& where, const std::string& what) {
    return parse<int>(trimmed(text), where, what, "is not an integer");
}

bool parse_boolean(const std::string& text, const SourceLocation& where, const std::string& what) {
    const std::string_view value = trimmed(text);
    if (value != "true" && value != "false") fail(where, what, text, "is not a boolean; valid names: true, false");
    return value == "true";
}

double parse_with_unit(const std::string& text, const std::string& unit, const SourceLocation& where,
                       const std::string& what) {
    std::string_view number = trimmed(text);
    if (number.ends_with(unit)) number = trimmed(number.substr(0, number.size() - unit.size()));
    return parse_finite(number, where, what);
}

std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where, const std::string& what) {
    std::vector<double> values;
    std::string_view rest = trimmed(text);
    if (rest.empty()) fail(where, what, text, "holds no number");
    while (true) {
        const auto length = std::min(rest.find_first_of(" \t\r\n,"), rest.size());
        if (length == 0) fail(where, what, text, "has a comma without a number before it");
        values.push_back(parse_finite(rest.substr(0, length), where, what));
        rest.remove_prefix(length);
        rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
        if (rest.empty()) return values;
        if (rest.front() != ',') continue;
        rest.remove_prefix(1);
        rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
        if (rest.empty()) fail(where, what, text, "ends with a comma");
    }
}

std::string number_text(double value) { return fmt::format("{:.6g}", value); }

}  // namespace keyhole
