#include "scene/shapes/cylinder.h"

#include <cmath>
#include <stdexcept>

#include "base/frame.h"
#include "base/warp.h"

namespace keyhole {

Cylinder::Cylinder(const Vec3& p0, const Vec3& p1, double radius, const Affine& to_world) {
    const double length = (p1 - p0).norm();
    if (!(radius > 0 && length > 0) || !std::isfinite(radius) || !std::isfinite(length)) {
        throw std::invalid_argument("cylinder: the radius must be positive and p0 and p1 finite and different");
    }
    const double scale = uniform_scale(to_world, "cylinder");
    const Frame frame = Frame::from_normal((p1 - p0) / length);
    Affine place;
    place.linear().col(0) = radius * frame.s;
    place.linear().col(1) = radius * frame.t;
    place.linear().col(2) = length * frame.n;
    place.translation() = p0;
    set_transform(to_world * place, 2 * pi * radius * length * scale * scale);
}

// As for the sphere, in the plane perpendicular to the axis.
AnalyticShape::Roots Cylinder::roots(const Vec3& o, const Vec3& d) const {
    const Vec2 q = o.head<2>(), w = d.head<2>();
    const double a = w.squaredNorm();
    if (a == 0) return {};
    const double b = -q.dot(w);
    const Vec2 closest = q + (b / a) * w;
    return solve(a, b, q.squaredNorm() - 1, a * (1 - closest.squaredNorm()));
}

AnalyticShape::Point Cylinder::project(const Vec3& p) const {
    const double r = std::hypot(p.x(), p.y());
    const double x = r > 0 ? p.x() / r : 1, y = r > 0 ? p.y() / r : 0;
    return {{x, y, p.z()}, {x, y, 0}};
}

AnalyticShape::Parameters Cylinder::parameters(const Vec3& p) const {
    return {{azimuth_to_unit(p.x(), p.y()), p.z()}, {-2 * pi * p.y(), 2 * pi * p.x(), 0}, {0, 0, 1}};
}

Vec3 Cylinder::sample_local(const Vec2& u) const { return {std::cos(2 * pi * u.x()), std::sin(2 * pi * u.x()), u.y()}; }

Vec2 Cylinder::invert_local(const Vec3& p) const { return {azimuth_to_unit(p.x(), p.y()), clamp01(p.z())}; }

}  // namespace keyhole
