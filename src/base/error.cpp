#include "base/error.h"

#include <algorithm>
#include <numeric>

namespace keyhole {
namespace {

std::string located(const SourceLocation& where, const std::string& message) {
    std::string text = where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
    return text.empty() ? message : text + ": " + message;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitute = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row.back();
}

}  // namespace

InputError::InputError(SourceLocation where, const std::string& message)
    : std::runtime_error(located(where, message)), where_(std::move(where)) {}

std::string valid_names(const std::string& found, const std::vector<std::string>& names) {
    std::string text;
    const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
        return edit_distance(found, a) < edit_distance(found, b);
    });
    if (nearest != names.end() && edit_distance(found, *nearest) <= 1 + found.size() / 4)
        text = "did you mean '" + *nearest + "'? ";
    text += "valid names:";
    if (names.empty()) text += " none";
    for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : " ") + names[i];
    return text;
}

}  // namespace keyhole
