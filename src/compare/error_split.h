// The error of an image split into noise, which goes away with time, and bias, which stays.
#pragma once

#include <span>

#include "compare/estimate.h"
#include "render/image.h"

namespace keyhole {

// With w = 1 / (R^2 + epsilon mean(R)^2) as in the relative metrics (metrics.h), and means over all values:
//     variance      = mean(w Var(I)),             the expected relMSE of a run without bias,
//     squared bias  = mean(w (E(I) - E(R))^2).
// Both are estimated without bias (of w, the noise of R is not taken out): the sample variance, and
// w ((mean of runs - R)^2 - sample variance / runs - variance of R), which may be negative by chance.
struct ErrorSplit {
    Estimate variance, squared_bias;
};

// `runs`: at least two independent images. `reference_variance`: per value, of R; null if R has no noise or it is not
// known, which then counts as bias. All of one size; pixels with a value that is not finite are left out.
ErrorSplit split_error(std::span<const Image> runs, const Image& reference, const Image* reference_variance);

// mean(w variance): the relMSE of the reference itself.
double reference_relmse(const Image& reference, const Image& reference_variance);

}  // namespace keyhole
