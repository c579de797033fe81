// A target on [0, 1) with a gap where it is zero, and the symmetric steps that tests make on it.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/vec.h"
#include "targets.h"

namespace keyhole {

// Not normalised: 1 + 0.8 sin(2 pi u) below 0.7, zero in the gap [0.7, 0.85), 3 above.
inline double interval_target(double u) {
    if (u < 0.7) return 1 + 0.8 * std::sin(2 * pi * u);
    return u < 0.85 ? 0 : 3;
}

inline constexpr std::size_t interval_cells = 20;
inline std::size_t interval_cell(double u) { return static_cast<std::size_t>(u * interval_cells); }

// Expected counts of the cells for `total` samples (the target's pieces end at cell boundaries).
inline std::vector<double> expected_in_cells(double total) {
    std::vector<double> mass;
    for (std::size_t i = 0; i < interval_cells; ++i) {
        const double a = static_cast<double>(i) / interval_cells, b = a + 1.0 / interval_cells, middle = (a + b) / 2;
        const double constant = middle < 0.7 ? 1 : (middle < 0.85 ? 0 : 3);
        const double wave = middle < 0.7 ? 0.8 * (std::cos(2 * pi * a) - std::cos(2 * pi * b)) / (2 * pi) : 0;
        mass.push_back(constant * (b - a) + wave);
    }
    return scaled(mass, total);
}

inline double draw_from_interval_target(Rng& random) {
    for (;;) {
        const double u = random.uniform();
        if (random.uniform() * 3 < interval_target(u)) return u;
    }
}

// A proposal of the state y by a kernel whose densities cancel.
inline Proposal symmetric_proposal(double x, double y) {
    if (!(interval_target(y) > 0)) return Proposal::failed(Failure::occluded);
    return {interval_target(y) / interval_target(x)};
}

// Triangular density of half-width `width` about zero.
inline double draw_triangular(double width, Rng& random) { return (random.uniform() + random.uniform() - 1) * width; }
inline double triangular_pdf(double offset, double width) {
    return std::max(0.0, 1 - std::abs(offset) / width) / width;
}

inline double wrapped(double u) { return clamp01(u - std::floor(u)); }
inline double reflected(double u) { return clamp01(u < 0 ? -u : (u >= 1 ? 2 - u : u)); }
// Signed distance on the circle of length one, in [-0.5, 0.5].
inline double wrapped_difference(double a, double b) { return std::remainder(a - b, 1.0); }

}  // namespace keyhole
