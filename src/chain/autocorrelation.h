// The autocorrelation of a chain's samples, lag by lag.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "chain/running_mean.h"

namespace keyhole {

// For studies of a kernel, not for the sampling loop: a sample costs max_lag multiplications.
class Autocorrelation {
  public:
    explicit Autocorrelation(std::size_t max_lag) : recent_(max_lag + 1), products_(max_lag + 1) {}

    void add(double x) {
        if (samples_.count() == 0) origin_ = x;
        const std::size_t size = recent_.size(), newest = static_cast<std::size_t>(samples_.count() % size);
        samples_.add(x);
        recent_[newest] = x - origin_;  // products of small numbers: the mean is subtracted below
        const std::size_t lags = samples_.count() < size ? static_cast<std::size_t>(samples_.count()) : size;
        for (std::size_t lag = 0; lag < lags; ++lag)
            products_[lag] += recent_[newest] * recent_[newest >= lag ? newest - lag : newest + size - lag];
    }

    std::size_t max_lag() const { return products_.size() - 1; }
    std::uint64_t count() const { return samples_.count(); }

    // Correlation of samples `lag` <= max_lag() apart, with an error of the order lag / count(). 0 if not known: fewer
    // samples than that, or all samples equal.
    double at(std::size_t lag) const {
        if (count() <= lag) return 0;
        const double mean = samples_.mean() - origin_;
        const double variance = products_[0] / static_cast<double>(count()) - mean * mean;
        if (!(variance > 0)) return 0;
        return (products_[lag] / static_cast<double>(count() - lag) - mean * mean) / variance;
    }

    // 1 + 2 sum of the correlations at all lags, summed up to the first lag that is `window` times the sum so far (or
    // `window` itself, if the sum is below one: anticorrelated samples) [Sokal 1997, Monte Carlo Methods in Statistical
    // Mechanics, section 3]. The number of samples over this is the effective sample size. If max_lag() ends the sum,
    // the result is too small.
    double integrated_time(double window = 5) const {
        double time = 1;
        for (std::size_t lag = 1; lag <= max_lag() && static_cast<double>(lag) < window * std::max(1.0, time); ++lag)
            time += 2 * at(lag);
        return time;
    }

  private:
    RunningMean samples_;
    double origin_ = 0;
    std::vector<double> recent_;    // ring buffer of the last samples
    std::vector<double> products_;  // sum of x_i x_{i - lag}, about the origin
};

}  // namespace keyhole
