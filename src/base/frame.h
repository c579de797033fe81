// Orthonormal frames. In local coordinates the normal is +z.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace keyhole {

struct Frame {
    Vec3 s, t, n;

    Vec3 to_local(const Vec3& v) const { return {v.dot(s), v.dot(t), v.dot(n)}; }
    Vec3 to_world(const Vec3& v) const { return s * v.x() + t * v.y() + n * v.z(); }

    // A frame about the unit normal `n`, without branches and exact at both poles
    // [Duff et al. 2017, Building an Orthonormal Basis, Revisited].
    static Frame from_normal(const Vec3& n) {
        const double sign = std::copysign(1.0, n.z());
        const double a = -1.0 / (sign + n.z());
        const double b = n.x() * n.y() * a;
        return {{1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()}, {b, sign + n.y() * n.y() * a, -n.y()}, n};
    }

    // A frame about the unit normal `n` whose `s` lies in the half-plane of `tangent` (must not be parallel to `n`).
    static Frame from_normal_and_tangent(const Vec3& n, const Vec3& tangent) {
        const Vec3 s = (tangent - n * n.dot(tangent)).normalized();
        return {s, n.cross(s), n};
    }
};

// Local-frame shorthands.
inline double cos_theta(const Vec3& w) { return w.z(); }
inline double abs_cos_theta(const Vec3& w) { return std::abs(w.z()); }

}  // namespace keyhole
