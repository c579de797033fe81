// Symmetric steps in primary sample space, wrapped to the unit torus.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/lanes.h"
#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {

// x in [0,1) plus any finite step, wrapped to [0,1).
inline double wrap_unit(double x) {
    const double y = x - std::floor(x);
    return y < 1 ? y : 0;  // -1e-20 wraps to 1 in floating point
}

// The same for four coordinates and steps in (-1, 1), without branches.
inline Double4 wrap_unit(Double4 x) {
    const auto one = std::bit_cast<Int64x4>(Double4{1, 1, 1, 1});
    x += std::bit_cast<Double4>(one & (x < 0)) - std::bit_cast<Double4>(one & (x >= 1));
    return std::bit_cast<Double4>(std::bit_cast<Int64x4>(x) & (x < 1));
}

// The shortest way from b to a around the torus, in [-1/2, 1/2].
inline double wrapped_difference(double a, double b) { return std::remainder(a - b, 1.0); }

// 2^x for x in [-126, 0], to 4e-6 relative: Taylor's series for the fraction in [-1/2, 1/2], the exponent by its bits.
inline Float8 exp2_approximate(Float8 x) {
    const Int32x8 whole = __builtin_convertvector(x - 0.5f, Int32x8);
    const Float8 f = x - __builtin_convertvector(whole, Float8);
    const Float8 series =
        1 + f * (0.693147182f + f * (0.240226507f + f * (0.0555041087f + f * (0.00961812911f + f * 0.00133335581f))));
    return series * std::bit_cast<Float8>((whole + 127) << 23);
}

// |step| = s2 (s1/s2)^U, uniform in logarithm between s1 and s2 [Kelemen 2002, section 4].
struct KelemenKernel {
    explicit KelemenKernel(double s1 = 1.0 / 1024, double s2 = 1.0 / 64)
        : scale_(static_cast<float>(s2)),
          log2_ratio_(static_cast<float>(std::max(std::log2(s1 / s2), smallest_log2)) * 0x1p-31f) {}

    // `n` coordinates at once, and those up to the next multiple of `lanes` with them (of no meaning). One random word
    // each: a sign and a magnitude, which are independent, so the step is symmetric whatever the rounding of the
    // magnitude.
    void operator()(const double* x, double* y, int n, Rng& rng) const {
        for (int first = 0; first < n; first += lanes) {
            const auto words = load_lanes<UInt32x8>(rng.bits(lanes));
            const Float8 uniform = __builtin_convertvector(std::bit_cast<Int32x8>(words >> 1), Float8);
            const Float8 magnitude = scale_ * exp2_approximate(log2_ratio_ * uniform);
            const auto step = std::bit_cast<Float8>(std::bit_cast<UInt32x8>(magnitude) | words << 31);
            store_lanes(wrap_unit(load_lanes<Double4>(x + first) + low_half(step)), y + first);
            store_lanes(wrap_unit(load_lanes<Double4>(x + first + 4) + high_half(step)), y + first + 4);
        }
    }

    KelemenKernel scaled(double factor) const {
        return KelemenKernel(smallest() * factor, static_cast<double>(scale_) * factor);
    }

    // q(a, y) / q(b, y) of `n` coordinates, where b can step to y. The density of a step d in one coordinate is
    // 1 / (2 ln(s2/s1) |d|), s1 <= |d| <= s2.
    double density_ratio(const double* a, const double* b, const double* y, int n) const {
        const double s1 = smallest(), s2 = static_cast<double>(scale_);
        double ratio = 1;
        for (int i = 0; i < n; ++i) {
            const double from_a = std::abs(wrapped_difference(y[i], a[i]));
            if (from_a < s1 || from_a > s2) return 0;
            ratio *= std::abs(wrapped_difference(y[i], b[i])) / from_a;
        }
        return ratio;
    }

  private:
    double smallest() const {
        return static_cast<double>(scale_) * std::exp2(0x1p31 * static_cast<double>(log2_ratio_));
    }

    static constexpr double smallest_log2 = -126;  // of exp2_approximate; far below what moves a coordinate

    float scale_, log2_ratio_;
};

// Normal steps of standard deviation sigma in every coordinate (Box and Muller 1958).
struct GaussianKernel {
    explicit GaussianKernel(double sigma = 0.01) : sigma_(sigma) {}

    void operator()(const double* x, double* y, int n, Rng& rng) const {
        for (int i = 0; i < n; i += 2) {
            const double radius = sigma_ * std::sqrt(-2 * std::log(1 - rng.uniform())), phi = 2 * pi * rng.uniform();
            y[i] = wrap_unit(x[i] + radius * std::cos(phi));
            if (i + 1 < n) y[i + 1] = wrap_unit(x[i + 1] + radius * std::sin(phi));
        }
    }

    GaussianKernel scaled(double factor) const { return GaussianKernel(sigma_ * factor); }

    // q(a, y) / q(b, y) of `n` coordinates.
    double density_ratio(const double* a, const double* b, const double* y, int n) const {
        double log_ratio = 0;
        for (int i = 0; i < n; ++i) log_ratio += log_density(y[i] - a[i]) - log_density(y[i] - b[i]);
        return std::exp(log_ratio);
    }

  private:
    // Up to a constant. Steps of any number of turns around the torus lead to the same point; those of more than three
    // are left out, which is less than 1e-10 of the density for sigma <= 0.5.
    double log_density(double step) const {
        const double d = std::remainder(step, 1.0), inverse = 1 / (2 * sigma_ * sigma_);
        double turns = 0;  // the longer ways, relative to the shortest
        for (int m = 1; m <= 3; ++m)
            turns += std::exp((-2 * d - m) * m * inverse) + std::exp((2 * d - m) * m * inverse);
        return -d * d * inverse + std::log1p(turns);
    }

    double sigma_;
};

}  // namespace keyhole
