#include "scene/shapes/sphere.h"

#include <cmath>
#include <stdexcept>

#include "base/warp.h"

namespace keyhole {

Sphere::Sphere(const Vec3& center, double radius, const Affine& to_world) {
    if (!(radius > 0) || !std::isfinite(radius) || !center.allFinite()) {
        throw std::invalid_argument("sphere: the radius must be positive and the center finite");
    }
    const double r = radius * uniform_scale(to_world, "sphere");
    set_transform(Affine(to_world * Eigen::Translation3d(center) * Eigen::UniformScaling<double>(radius)),
                  4 * pi * r * r);
}

// The discriminant from the line's closest approach to the centre keeps its digits for far and grazing rays
// [Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection].
AnalyticShape::Roots Sphere::roots(const Vec3& o, const Vec3& d) const {
    const double a = d.squaredNorm(), b = -o.dot(d);
    const Vec3 closest = o + (b / a) * d;
    return solve(a, b, o.squaredNorm() - 1, a * (1 - closest.squaredNorm()));
}

AnalyticShape::Point Sphere::project(const Vec3& p) const {
    const Vec3 n = p.normalized();
    return {n, n};
}

AnalyticShape::Parameters Sphere::parameters(const Vec3& p) const {
    const double rho = std::hypot(p.x(), p.y());
    // At the poles dp/du vanishes; a direction for it is kept.
    const double cos_phi = rho > 0 ? p.x() / rho : 1, sin_phi = rho > 0 ? p.y() / rho : 0;
    const double length = 2 * pi * std::max(rho, 1e-6);
    return {{azimuth_to_unit(p.x(), p.y()), std::atan2(rho, p.z()) * inv_pi},
            {-sin_phi * length, cos_phi * length, 0},
            {pi * p.z() * cos_phi, pi * p.z() * sin_phi, -pi * rho}};
}

Vec3 Sphere::sample_local(const Vec2& u) const { return square_to_sphere(u); }

Vec2 Sphere::invert_local(const Vec3& p) const { return sphere_to_square(p); }

}  // namespace keyhole
