// Warps of the unit square, in triplets: X (sample), X_pdf and X_inverse, each pair exact inverses of one another.
// `u` is in [0,1)^2; densities are in the measure each comment names; inverses return values in [0,1).
#pragma once

#include <cmath>

#include "base/vec.h"

namespace keyhole {

// Concentric map to the unit disk [Shirley and Chiu 1997]. pdf: area, 1/pi.
inline Vec2 square_to_disk(const Vec2& u) {
    const double a = 2 * u.x() - 1, b = 2 * u.y() - 1;
    if (a == 0 && b == 0) return {0, 0};
    if (std::abs(a) > std::abs(b)) {
        const double phi = (pi / 4) * (b / a);
        return {a * std::cos(phi), a * std::sin(phi)};
    }
    const double phi = (pi / 4) * (a / b);
    return {b * std::sin(phi), b * std::cos(phi)};
}
inline double square_to_disk_pdf() { return inv_pi; }
inline Vec2 disk_to_square(const Vec2& p) {
    const double r = p.norm();
    double a, b;
    if (std::abs(p.x()) > std::abs(p.y())) {
        a = std::copysign(r, p.x());
        b = a * std::atan(p.y() / p.x()) * (4 / pi);
    } else {
        b = std::copysign(r, p.y());
        a = p.y() == 0 ? 0 : b * std::atan(p.x() / p.y()) * (4 / pi);
    }
    return {clamp01((a + 1) / 2), clamp01((b + 1) / 2)};
}

// Cosine-weighted hemisphere about +z. pdf: solid angle, cos/pi.
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
    const Vec2 p = square_to_disk(u);
    return {p.x(), p.y(), safe_sqrt(1 - p.squaredNorm())};
}
inline double square_to_cosine_hemisphere_pdf(const Vec3& w) { return w.z() > 0 ? w.z() * inv_pi : 0; }
inline Vec2 cosine_hemisphere_to_square(const Vec3& w) { return disk_to_square({w.x(), w.y()}); }

// Uniform sphere. pdf: solid angle, 1/(4 pi).
inline Vec3 square_to_sphere(const Vec2& u) {
    const double z = 1 - 2 * u.x(), r = 2 * safe_sqrt(u.x() * (1 - u.x())), phi = 2 * pi * u.y();
    return {r * std::cos(phi), r * std::sin(phi), z};
}
inline double square_to_sphere_pdf() { return inv_pi / 4; }
inline double azimuth_to_unit(double x, double y) {
    const double phi = std::atan2(y, x) * (inv_pi / 2);
    return clamp01(phi < 0 ? phi + 1 : phi);
}
inline Vec2 sphere_to_square(const Vec3& w) {
    // Near the poles 1 - z loses all digits; there x^2 + y^2 = 4u(1-u) keeps them.
    const double r2 = w.x() * w.x() + w.y() * w.y();
    const double small = r2 / (2 * (1 + std::sqrt(std::max(0.0, 1 - r2))));
    return {clamp01(std::abs(w.z()) < 0.5 ? (1 - w.z()) / 2 : (w.z() > 0 ? small : 1 - small)),
            azimuth_to_unit(w.x(), w.y())};
}

// Uniform cone about +z of half-angle acos(cos_max). pdf: solid angle, 1/(2 pi (1 - cos_max)).
inline Vec3 square_to_cone(const Vec2& u, double cos_max) {
    const double h = u.x() * (1 - cos_max), r = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y();
    return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline double square_to_cone_pdf(double cos_max) { return inv_pi / (2 * (1 - cos_max)); }
inline Vec2 cone_to_square(const Vec3& w, double cos_max) {
    const double r2 = w.x() * w.x() + w.y() * w.y();
    const double h = w.z() > 0 ? r2 / (1 + std::sqrt(std::max(0.0, 1 - r2))) : 1 - w.z();
    return {clamp01(h / (1 - cos_max)), azimuth_to_unit(w.x(), w.y())};
}

// Uniform triangle, as barycentric coordinates of its second and third corner. pdf: 1/area.
// The fold at the diagonal keeps the map continuous except there [Heitz 2019, A Low-Distortion Map].
inline Vec2 square_to_triangle(const Vec2& u) {
    double x = u.x(), y = u.y();
    if (y > x) {
        x *= 0.5;
        y -= x;
    } else {
        y *= 0.5;
        x -= y;
    }
    return {x, y};
}
inline Vec2 triangle_to_square(const Vec2& b) {
    return b.y() > b.x() ? Vec2(clamp01(2 * b.x()), clamp01(b.x() + b.y()))
                         : Vec2(clamp01(b.x() + b.y()), clamp01(2 * b.y()));
}

}  // namespace keyhole
