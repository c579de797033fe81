// How much a chain's correlated samples are worth, in constant memory.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "chain/running_mean.h"

namespace keyhole {

// The error of the mean of correlated samples by the method of batch means: means of long batches are nearly
// independent. The batches get longer as the run does: there are always between max_batches / 2 and max_batches of them
// [Flegal and Jones 2010, Batch Means and Spectral Variance Estimators in Markov Chain Monte Carlo].
//
// With m batches the estimated error has a relative standard error of about 1 / sqrt(2 m), so 6 to 9%. It is too small
// as long as a batch is not much longer than the correlation time.
class BatchMeans {
  public:
    static constexpr std::size_t max_batches = 128;

    void add(double x) {
        samples_.add(x);
        sum_ += x;
        if (++filled_ < batch_length_) return;
        sums_[batches_++] = sum_;
        sum_ = 0;
        filled_ = 0;
        if (batches_ == max_batches) merge_pairs();
    }

    std::uint64_t count() const { return samples_.count(); }
    double mean() const { return samples_.mean(); }
    double variance() const { return samples_.variance(); }  // of one sample
    std::uint64_t batch_length() const { return batch_length_; }

    // Standard error of mean(); infinite for less than two batches.
    double standard_error() const {
        RunningMean means;
        for (std::size_t i = 0; i < batches_; ++i) means.add(sums_[i] / static_cast<double>(batch_length_));
        if (means.count() < 2) return std::numeric_limits<double>::infinity();
        return std::sqrt(means.variance() * static_cast<double>(batch_length_) / static_cast<double>(count()));
    }

    // The number of independent samples whose mean would have the same error; 0 for less than two batches. Can exceed
    // count(): samples may be anticorrelated.
    double effective_sample_size() const {
        const double error = standard_error();
        if (!std::isfinite(error)) return 0;
        return error > 0 ? variance() / (error * error) : static_cast<double>(count());
    }

  private:
    void merge_pairs() {
        batches_ /= 2;
        for (std::size_t i = 0; i < batches_; ++i) sums_[i] = sums_[2 * i] + sums_[2 * i + 1];
        batch_length_ *= 2;
    }

    RunningMean samples_;
    std::array<double, max_batches> sums_{};
    std::size_t batches_ = 0;
    std::uint64_t batch_length_ = 1, filled_ = 0;
    double sum_ = 0;  // of the batch that is being filled
};

}  // namespace keyhole
