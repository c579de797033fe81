#include "compare/estimate.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "chain/running_mean.h"

namespace keyhole {

double student_quantile(double degrees_of_freedom) {
    return -boost::math::quantile(boost::math::students_t(degrees_of_freedom), (1 - confidence_level) / 2);
}

Estimate estimate_mean(std::span<const double> values) {
    RunningMean mean;
    for (const double v : values) mean.add(v);
    Estimate estimate{mean.mean(), {}};
    if (values.size() < 2) return estimate;
    const double half = student_quantile(static_cast<double>(values.size() - 1)) * mean.standard_error();
    estimate.interval = {mean.mean() - half, mean.mean() + half};
    return estimate;
}

Estimate jackknife(double whole, std::span<const double> one_left_out) {
    const double n = static_cast<double>(one_left_out.size());
    if (one_left_out.size() < 3) return {whole, {}};
    std::vector<double> pseudo_values;
    for (const double without : one_left_out) pseudo_values.push_back(n * whole - (n - 1) * without);
    return estimate_mean(pseudo_values);
}

nlohmann::json to_json(const Estimate& estimate) {
    nlohmann::json json = {{"mean", estimate.mean}};
    if (estimate.interval) {
        json["low"] = estimate.interval->low;
        json["high"] = estimate.interval->high;
    }
    return json;
}

}  // namespace keyhole
