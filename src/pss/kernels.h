// Symmetric steps in primary sample space, wrapped to the unit torus.
#pragma once

#include <cmath>

#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {

// x in [0,1) plus any finite step, wrapped to [0,1).
inline double wrap_unit(double x) {
    const double y = x - std::floor(x);
    return y < 1 ? y : 0;  // -1e-20 wraps to 1 in floating point
}

// |step| = s2 (s1/s2)^U, uniform in logarithm between s1 and s2 [Kelemen 2002, section 4].
struct KelemenKernel {
    explicit KelemenKernel(double s1 = 1.0 / 1024, double s2 = 1.0 / 64)
        : scale_(static_cast<float>(s2)), log2_ratio_(static_cast<float>(std::log2(s1 / s2)) * 0x1p-31f) {}

    // `n` coordinates at once. One random word each: a sign and a magnitude, which are independent, so the step is
    // symmetric whatever the rounding of the magnitude.
    void operator()(const double* x, double* y, int n, Rng& rng) const {
        for (int i = 0; i < n; ++i) {
            const std::uint32_t word = rng.bits();
            const float magnitude = scale_ * std::exp2(log2_ratio_ * static_cast<float>(word >> 1));
            y[i] = wrap_unit(x[i] + ((word & 1) ? magnitude : -magnitude));
        }
    }

  private:
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

  private:
    double sigma_;
};

}  // namespace keyhole
