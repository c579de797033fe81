// The inverse of the standard normal distribution function.
#pragma once

namespace keyhole {

// z with Phi(z) = u, for u in (0,1); relative error about 1e-16 [Wichura 1988, Algorithm AS 241, PPND16].
// The ends are kept finite: u = 0 gives the value at 2^-54.
double normal_quantile(double u);

// Phi(z), accurate in relative terms in the left tail too.
double normal_cdf(double z);

}  // namespace keyhole
