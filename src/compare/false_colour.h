// Error images in false colours.
#pragma once

#include <span>

#include "render/image.h"

namespace keyhole {

// The errors, row by row from the top, in the perceptually uniform map "magma": black for 0, pale yellow for `maximum`
// (> 0) and more. What is not a number becomes mid-grey. The result is linear, so that a PNG shows the map's colours.
Image false_colour(std::span<const double> errors, int width, double maximum);

// The value below which the share `fraction` of the errors lies, leaving out what is not a number; 0 if nothing is
// left.
double error_quantile(std::span<const double> errors, double fraction);

}  // namespace keyhole
