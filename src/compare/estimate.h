// Means over independent runs, with confidence intervals.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

namespace keyhole {

inline constexpr double confidence_level = 0.95;

struct Interval {
    double low = 0, high = 0;
};

struct Estimate {
    double mean = 0;
    std::optional<Interval> interval;  // at confidence_level; none from a single run
};

// Half the width of the interval in standard errors: the quantile of Student's t, two-sided. `degrees_of_freedom` > 0.
double student_quantile(double degrees_of_freedom);

// Student's t: exact for normally distributed values, good for means of many pixels. `values` is not empty.
Estimate estimate_mean(std::span<const double> values);

// Of a statistic of n runs, from its n values with one run left out each time [Quenouille 1956; Tukey 1958]. No
// interval for n < 3. `whole`: its value from all runs.
Estimate jackknife(double whole, std::span<const double> one_left_out);

nlohmann::json to_json(const Estimate& estimate);

}  // namespace keyhole
