// Text to values, strictly: no trailing characters, no nan, no infinity, no overflow.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace keyhole {

// `what` names the value in the error, e.g. "float 'alpha'". Surrounding white space is allowed.
double parse_number(const std::string& text, const SourceLocation& where, const std::string& what);
int parse_integer(const std::string& text, const SourceLocation& where, const std::string& what);
bool parse_boolean(const std::string& text, const SourceLocation& where, const std::string& what);

// A number followed by an optional unit, e.g. "50mm".
double parse_with_unit(const std::string& text, const std::string& unit, const SourceLocation& where,
                       const std::string& what);

// Numbers separated by white space, or by one comma and optional white space.
std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where, const std::string& what);

// A number as short as it can be written without loss to six digits, for messages.
std::string number_text(double value);

}  // namespace keyhole
