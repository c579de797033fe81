// Statistics shared by the tests: p-values, and the level they are held against.
#pragma once

#include <cmath>
#include <vector>

namespace keyhole {

// Level of one of `tests` tests such that all of them together raise a false alarm with probability `family_level`
// (Sidak; exact for independent tests).
inline double sidak_level(double family_level, int tests) { return -std::expm1(std::log1p(-family_level) / tests); }

// Probability that a chi-square variable exceeds `statistic`.
double chi_square_tail(double statistic, double degrees_of_freedom);

// P(|T| > |t|) of Student's distribution.
double student_two_sided_tail(double t, double degrees_of_freedom);

// z such that a standard normal variable exceeds |z| in magnitude with probability `level`.
double normal_two_sided_quantile(double level);

// Pearson's chi-square of observed counts against expected ones (same totals). Cells that expect fewer than five are
// pooled into one; should the pool itself expect fewer, it is tested by the Poisson tail and the two p-values are
// combined (Bonferroni). A sample where nothing is expected gives 0.
double chi_square_p_value(const std::vector<double>& expected, const std::vector<double>& observed);

}  // namespace keyhole
