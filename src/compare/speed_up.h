// How much sooner one method reaches the error of another.
#pragma once

#include <span>
#include <vector>

#include "compare/estimate.h"

namespace keyhole {

// The error of a method against what it costs: mean over runs at ascending costs.
struct ConvergencePoint {
    double cost = 0;    // seconds, CPU-seconds
    double relmse = 0;  // without that of the reference
};

// The cost at which the curve reaches `relmse`: between two points along the line through them in logarithms, and
// beyond the ends along lines of slope -1, as errors that are all noise go. The first crossing if there are several.
// All numbers are > 0; the curve is not empty.
double cost_at(std::span<const ConvergencePoint> curve, double relmse);

struct Converging {
    std::vector<ConvergencePoint> curve;
    std::vector<double> relmse_of_runs;  // at the last point
};

// The cost of `first` over that of `other` at equal relmse: the larger of the two at the end, so that neither curve is
// extrapolated to smaller errors. Its interval comes from the spread of the logarithms of the runs' errors (Welch).
Estimate speed_up(const Converging& first, const Converging& other);

}  // namespace keyhole
