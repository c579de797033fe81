// Warps of the unit square, in triplets: X (sample), X_pdf and X_inverse, each pair exact inverses of one another.
// `u` is in [0,1)^2; densities are in the measure each comment names; inverses return values in [0,1).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace keyhole {

// condition ? a : b, never compiled to a branch: for conditions that no predictor can learn.
inline double select(bool condition, double a, double b) {
    const std::uint64_t mask = 0 - static_cast<std::uint64_t>(condition);
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) | (std::bit_cast<std::uint64_t>(b) & ~mask));
}

// cos(pi t / 4) and sin(pi t / 4) for |t| <= 1: Chebyshev interpolants in t^2, truncation errors 5e-17 and 3e-18.
inline double cos_quarter_pi(double t) {
    const double y = t * t;
    return 1.0 +
           y * (-0.30842513753403783 +
                y * (0.015854344243741547 +
                     y * (-0.00032599188648354014 +
                          y * (3.590859179850238e-06 + y * (-2.4609507094028117e-08 + y * 1.1365469207731353e-10)))));
}
inline double sin_quarter_pi(double t) {
    const double y = t * t;
    return t *
           (0.7853981633974483 +
            y * (-0.08074551218828054 +
                 y * (0.002490394570188844 +
                      y * (-3.657620415891387e-05 +
                           y * (3.133616225433416e-07 + y * (-1.7571500746983935e-09 + y * 6.877360573166326e-12))))));
}

// Concentric map to the unit disk [Shirley and Chiu 1997], without branches. pdf: area, 1/pi.
struct PointOnDisk {
    Vec2 p;
    double r;  // exact distance from the centre
};
inline PointOnDisk square_to_disk_and_radius(const Vec2& u) {
    const double a = 2 * u.x() - 1, b = 2 * u.y() - 1;
    const bool wide = std::abs(a) > std::abs(b);
    const double r = select(wide, a, b), t = select(wide, b, a) / (r == 0 ? 1 : r);
    const double along = r * cos_quarter_pi(t), across = r * sin_quarter_pi(t);
    return {{select(wide, along, across), select(wide, across, along)}, std::abs(r)};
}
inline Vec2 square_to_disk(const Vec2& u) { return square_to_disk_and_radius(u).p; }
inline double square_to_disk_pdf() { return inv_pi; }
inline Vec2 disk_to_square(const Vec2& p, double r) {  // r = |p|
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
inline Vec2 disk_to_square(const Vec2& p) { return disk_to_square(p, p.norm()); }

// Cosine-weighted hemisphere about +z. pdf: solid angle, cos/pi.
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
    const PointOnDisk d = square_to_disk_and_radius(u);
    return {d.p.x(), d.p.y(), std::sqrt((1 - d.r) * (1 + d.r))};
}
inline double square_to_cosine_hemisphere_pdf(const Vec3& w) { return w.z() > 0 ? w.z() * inv_pi : 0; }
inline Vec2 cosine_hemisphere_to_square(const Vec3& w) {
    // Near the horizon the distance from the disk's edge is better known from z than from x and y.
    const Vec2 p(w.x(), w.y());
    const double r = p.norm();
    return disk_to_square(p, w.z() < 0.5 ? 1 - w.z() * w.z() / (1 + r) : r);
}

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
    // Near the poles 1 - |z| loses all digits; x^2 + y^2 = (1 - |z|) (1 + |z|) keeps them.
    const double z = std::abs(w.z()), near_pole = (w.x() * w.x() + w.y() * w.y()) / (2 * (1 + z));
    return {clamp01(z < 0.5 ? (1 - w.z()) / 2 : (w.z() > 0 ? near_pole : 1 - near_pole)),
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
    const double h = w.z() > 0.5 ? r2 / (1 + w.z()) : 1 - w.z();
    return {clamp01(h / (1 - cos_max)), azimuth_to_unit(w.x(), w.y())};
}

// Power-cosine lobe about +z. pdf: solid angle, (n+1)/(2 pi) cos^n on the upper hemisphere, n >= 0.
inline Vec3 square_to_cosine_power(const Vec2& u, double exponent) {
    // h = 1 - cos keeps its digits where the lobe is narrow.
    const double h = -std::expm1(std::log(u.x()) / (exponent + 1));
    const double r = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y();
    return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline double square_to_cosine_power_pdf(const Vec3& w, double exponent) {
    return w.z() > 0 ? (exponent + 1) * (0.5 * inv_pi) * std::pow(w.z(), exponent) : 0;
}
inline Vec2 cosine_power_to_square(const Vec3& w, double exponent) {
    const double h = (w.x() * w.x() + w.y() * w.y()) / (1 + w.z());
    return {clamp01(std::exp((exponent + 1) * std::log1p(-h))), azimuth_to_unit(w.x(), w.y())};
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

// Density on [0,1) proportional to the line from `a` >= 0 at 0 to `b` >= 0 at 1; uniform if both are 0.
inline double unit_to_linear(double u, double a, double b) {
    const double root = a + std::sqrt(a * a + u * (b * b - a * a));
    return root > 0 ? clamp01(u * (a + b) / root) : u;
}
inline double unit_to_linear_pdf(double x, double a, double b) {
    return a + b > 0 ? 2 * (a + x * (b - a)) / (a + b) : 1;
}
inline double linear_to_unit(double x, double a, double b) {
    return a + b > 0 ? clamp01(x * (a * (2 - x) + b * x) / (a + b)) : x;
}

// The bilinear function on the unit square with these values >= 0 at the corners (x, y).
struct Bilinear {
    double v00, v10, v01, v11;

    double operator()(const Vec2& p) const { return left(p.y()) + p.x() * (right(p.y()) - left(p.y())); }
    double mean() const { return (v00 + v10 + v01 + v11) / 4; }
    double left(double y) const { return v00 + y * (v01 - v00); }
    double right(double y) const { return v10 + y * (v11 - v10); }
};
// Density on the unit square proportional to `f`; uniform if it is zero.
inline Vec2 square_to_bilinear(const Vec2& u, const Bilinear& f) {
    const double y = unit_to_linear(u.y(), f.v00 + f.v10, f.v01 + f.v11);
    return {unit_to_linear(u.x(), f.left(y), f.right(y)), y};
}
inline double square_to_bilinear_pdf(const Vec2& p, const Bilinear& f) {
    const double mean = f.mean();
    return mean > 0 ? f(p) / mean : 1;
}
inline Vec2 bilinear_to_square(const Vec2& p, const Bilinear& f) {
    return {linear_to_unit(p.x(), f.left(p.y()), f.right(p.y())), linear_to_unit(p.y(), f.v00 + f.v10, f.v01 + f.v11)};
}

}  // namespace keyhole
