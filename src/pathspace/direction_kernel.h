// The truncated reciprocal kernel of directions [Veach and Guibas 1997, 5.3.2; theory, section 7].
#pragma once

#include <cmath>
#include <limits>

#include "base/frame.h"

namespace keyhole {

// In radians, accurate at small angles too; both of unit length.
inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

// Angles from an axis between r_min and r_max (radians, 0 < r_min < r_max < pi), their logarithms uniform.
struct DirectionKernel {
    double r_min, r_max;

    // A direction about a unit axis by two numbers of [0, 1).
    Vec3 sample(const Vec3& axis, const Vec2& u) const {
        const double theta = r_max * std::pow(r_min / r_max, u.x()), phi = 2 * pi * u.y(), s = std::sin(theta);
        return Frame::from_normal(axis).to_world({s * std::cos(phi), s * std::sin(phi), std::cos(theta)});
    }

    // ln of the density per solid angle at that angle from the axis; -infinity outside of the support, whose borders
    // are widened by `slack` (relative), so that rounding does not refuse the way back.
    static constexpr double slack = 1e-9;
    double log_pdf(double theta) const {
        if (!(theta >= r_min * (1 - slack) && theta <= r_max * (1 + slack)))
            return -std::numeric_limits<double>::infinity();
        return -std::log(2 * pi * std::log(r_max / r_min) * theta * std::sin(theta));
    }
};

}  // namespace keyhole
