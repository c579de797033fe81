// How fast chains forget: autocorrelation times and effective sample sizes, without keeping the samples.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace keyhole {

// What the correlated samples of a quantity are worth. `time` is 1 + 2 sum of the correlations at all lags, and
// `samples` the number of steps over it.
struct Mixing {
    double autocorrelation_time = std::numeric_limits<double>::infinity();  // in steps; infinite: not known, or stuck
    double effective_sample_size = 0;
};

// The sums that a state's variance and mean come from, for N quantities at once.
template <std::size_t N>
struct StateMoments {
    std::uint64_t count = 0;
    std::array<double, N> sums{}, squares{};

    void add(const std::array<double, N>& values) {
        ++count;
        for (std::size_t i = 0; i < N; ++i) {
            sums[i] += values[i];
            squares[i] += values[i] * values[i];
        }
    }
    StateMoments& operator+=(const StateMoments& other) {
        count += other.count;
        for (std::size_t i = 0; i < N; ++i) {
            sums[i] += other.sums[i];
            squares[i] += other.squares[i];
        }
        return *this;
    }
    // 0 where it is not above what rounding makes of equal values.
    double variance(std::size_t i) const {
        if (count == 0) return 0;
        const double n = static_cast<double>(count), mean = sums[i] / n, variance = squares[i] / n - mean * mean;
        return variance > 1e-10 * squares[i] / n ? variance : 0;
    }
};

// Mean squared jumps of one strategy's proposals, each times its acceptance probability: what a step by this strategy
// moves. Integers, so that the sums of any number of threads are the same in any order.
template <std::size_t N>
struct JumpSums {
    std::uint64_t proposals = 0;
    std::array<std::uint64_t, N> squares{};  // in units

    // `units`: of the N sums; a sum holds 1.8e19 of them.
    void add(const std::array<double, N>& x, const std::array<double, N>& y, double acceptance,
             const std::array<double, N>& units) {
        ++proposals;
        if (!(acceptance > 0)) return;
        for (std::size_t i = 0; i < N; ++i)
            squares[i] += static_cast<std::uint64_t>(acceptance * (y[i] - x[i]) * (y[i] - x[i]) / units[i] + 0.5);
    }
    JumpSums& operator+=(const JumpSums& other) {
        proposals += other.proposals;
        for (std::size_t i = 0; i < N; ++i) squares[i] += other.squares[i];
        return *this;
    }
    double mean_square(std::size_t i, const std::array<double, N>& units) const {
        return proposals ? static_cast<double>(squares[i]) * units[i] / static_cast<double>(proposals) : 0;
    }
};

// From the error of the mean over `steps` steps of a quantity with the given variance. A few independent replicates
// know the error, and so the result, only roughly.
inline Mixing mixing_from_error(double variance, double squared_error, double steps) {
    if (!(variance > 0 && squared_error > 0 && std::isfinite(squared_error))) return {};
    const double samples = variance / squared_error;
    return {steps / samples, samples};
}

// An upper bound of what `steps` steps of a kernel alone are worth, for a quantity of the given variance whose mean
// squared jump is J. The kernel's correlation at lag one is r = 1 - J / (2 variance). For a reversible kernel the
// correlations are moments of a spectral measure, r the first and the autocorrelation time the integral of the convex
// (1 + s) / (1 - s): so the time is at least (1 + r) / (1 - r) = 4 variance / J - 1 (Jensen's inequality).
inline Mixing mixing_bound(double variance, double mean_square_jump, double steps) {
    if (!(variance > 0 && mean_square_jump > 0)) return {};
    const double time = 4 * variance / mean_square_jump - 1;
    return time > 0 ? Mixing{time, steps / time} : Mixing{};
}

}  // namespace keyhole
