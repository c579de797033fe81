// Mean, variance and standard error of independent samples.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace keyhole {

// Samples are taken one after the other [Welford 1962]; two sets can be merged [Chan et al. 1979], and merging in a
// fixed order gives the same result whoever made the sets.
class RunningMean {
  public:
    void add(double x) {
        ++count_;
        const double delta = x - mean_;
        mean_ += delta / static_cast<double>(count_);
        squares_ += delta * (x - mean_);
    }
    void merge(const RunningMean& other) {
        if (other.count_ == 0) return;
        const double n = static_cast<double>(count_), m = static_cast<double>(other.count_);
        const double delta = other.mean_ - mean_;
        count_ += other.count_;
        mean_ += delta * (m / (n + m));
        squares_ += other.squares_ + delta * delta * (n * m / (n + m));
    }

    std::uint64_t count() const { return count_; }
    double mean() const { return mean_; }
    // Unbiased; 0 for fewer than two samples.
    double variance() const { return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : 0; }
    // Standard error of mean(); infinite for fewer than two samples.
    double standard_error() const {
        return count_ > 1 ? std::sqrt(variance() / static_cast<double>(count_))
                          : std::numeric_limits<double>::infinity();
    }

  private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

}  // namespace keyhole
