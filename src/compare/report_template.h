// The page without its data, built from web/ (see web/README.md).
#pragma once

#include <string_view>

namespace keyhole {

// The place of the data in the template, which has it once.
inline constexpr std::string_view report_data_mark = "<!--KEYHOLE-DATA-->";

extern const std::string_view report_template;

}  // namespace keyhole
