#include "compare/speed_up.h"

#include <algorithm>
#include <cmath>

#include "chain/running_mean.h"

namespace keyhole {

double cost_at(std::span<const ConvergencePoint> curve, double relmse) {
    const auto extrapolate = [relmse](const ConvergencePoint& p) { return p.cost * p.relmse / relmse; };
    if (curve.front().relmse <= relmse) return extrapolate(curve.front());
    for (std::size_t i = 1; i < curve.size(); ++i) {
        if (curve[i].relmse > relmse) continue;
        const double along = std::log(curve[i - 1].relmse / relmse) / std::log(curve[i - 1].relmse / curve[i].relmse);
        return curve[i - 1].cost * std::pow(curve[i].cost / curve[i - 1].cost, along);
    }
    return extrapolate(curve.back());
}

Estimate speed_up(const Converging& first, const Converging& other) {
    const double relmse = std::max(first.curve.back().relmse, other.curve.back().relmse);
    Estimate estimate{cost_at(first.curve, relmse) / cost_at(other.curve, relmse), {}};
    double variance = 0, welch = 0;
    for (const Converging* c : {&first, &other}) {
        RunningMean logarithms;
        for (const double error : c->relmse_of_runs) logarithms.add(std::log(error));
        if (logarithms.count() < 2) return estimate;
        const double v = logarithms.variance() / static_cast<double>(logarithms.count());
        variance += v;
        welch += v * v / static_cast<double>(logarithms.count() - 1);
    }
    const double half = welch > 0 ? student_quantile(variance * variance / welch) * std::sqrt(variance) : 0;
    estimate.interval = {estimate.mean * std::exp(-half), estimate.mean * std::exp(half)};
    return estimate;
}

}  // namespace keyhole
