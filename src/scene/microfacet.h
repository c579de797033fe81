// Microfacet distributions and their visible normals.
//
// Local frame, macro-normal +z; `m` is a unit micro-normal with m.z > 0, `w` a unit direction pointing away from the
// surface. A is the projected area of the visible micro-surface per unit macro-area,
//     A(w) = integral of D(m) max(0, w.m) over the facets not masked = cos(w) / G1(w)   [Heitz 2014, eq. 14-17],
// and every term is written with it, because it stays positive and well conditioned down to grazing angles where
// cos(w) and G1(w) vanish together.
//
// Masking and shadowing are separable, G = G1(w_eye) G1(w_light), as in Mitsuba. G1 is exact for both distributions
// (Mitsuba's Beckmann G1 is a rational fit with an error of 0.35%), so that the density of visible normals is exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "scene/bsdfs.h"

namespace keyhole {

class Microfacet {
  public:
    static constexpr double min_alpha = 1e-4;

    // Roughness along the frame's s and t, raised to min_alpha. Beckmann: sqrt(2) times the RMS slope.
    Microfacet(MicrofacetType type, double alpha_x, double alpha_y)
        : type_(type),
          alpha_x_(std::max(alpha_x, min_alpha)),
          alpha_y_(std::max(alpha_y, min_alpha)),
          inv_alpha_x_(1 / alpha_x_),
          inv_alpha_y_(1 / alpha_y_) {}

    // D(m): area of facets with normal m, per unit macro-area and solid angle [Walter et al. 2007, eq. 25 and 33].
    double density(const Vec3& m) const {
        const double tx = m.x() * inv_alpha_x_, ty = m.y() * inv_alpha_y_, zz = m.z() * m.z(), tt = tx * tx + ty * ty;
        const double scale = inv_pi * inv_alpha_x_ * inv_alpha_y_;
        if (type_ == MicrofacetType::ggx) return scale / sqr(tt + zz);
        // Beyond, exp is 1e-260 or less: on the way to numbers without full precision.
        return tt > 600 * zz ? 0 : scale * std::exp(-tt / zz) / (zz * zz);
    }

    // A(w); the same for w and its mirror image below the surface.
    double projected_area(const Vec3& w) const {
        const double c = std::abs(w.z()), ss = sqr(alpha_x_ * w.x()) + sqr(alpha_y_ * w.y());
        if (type_ == MicrofacetType::ggx) return 0.5 * (c + std::sqrt(ss + c * c));
        return beckmann_projected_area(c, std::sqrt(ss));
    }

    // Smith's masking for directions that face the micro-normal.
    double g1(const Vec3& w) const { return std::abs(w.z()) / projected_area(w); }

    // Density of visible normals D_v(m) = D(m) max(0, w.m) / A(w), per solid angle of m, for w.z > 0.
    double visible_density(const Vec3& w, const Vec3& m) const {
        const double cos_m = w.dot(m);
        return cos_m > 0 ? density(m) * cos_m / projected_area(w) : 0;
    }

    // A bijection from the unit square to the normals visible from w, w.z > 0, with exactly that density, and its
    // inverse (for w.m > 0). Continuous; GGX: spherical caps [Dupuy and Benyoub 2023] through the concentric map;
    // Beckmann: the distribution function of the slopes [Heitz and d'Eon 2014], inverted to machine precision.
    // On the very rim of the square facets are seen edge-on, and rounding decides the sign of w.m.
    Vec3 sample_visible(const Vec3& w, const Vec2& u) const;
    Vec2 visible_to_square(const Vec3& w, const Vec3& m) const;

  private:
    static double beckmann_projected_area(double c, double s) {
        if (c > 6 * s) return c;  // erfc(6) = 2e-17
        const double a = c / s, inv_sqrt_pi = std::numbers::inv_sqrtpi;
        return 0.5 * (c * (1 + std::erf(a)) + s * std::exp(-a * a) * inv_sqrt_pi);
    }

    MicrofacetType type_;
    double alpha_x_, alpha_y_, inv_alpha_x_, inv_alpha_y_;
};

// A distribution whose roughness may vary over the surface.
class Roughness {
  public:
    Roughness(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v);

    Microfacet at(const Vec2& uv) const {
        return textured() ? Microfacet(type_, alpha_u_(uv), alpha_v_(uv)) : constant_;
    }
    bool textured() const { return alpha_u_.texture || alpha_v_.texture; }
    bool anisotropic() const;

  private:
    MicrofacetType type_;
    ScalarInput alpha_u_, alpha_v_;
    Microfacet constant_;
};

// Reflection at the facets, without the Fresnel factor.
struct FacetReflection {
    double cos_m;      // cosine of either direction to the micro-normal
    double value;      // D G / (4 |cos w_eye cos w_light|) = D / (4 A(w_eye) A(w_light))
    double pdf_light;  // solid-angle density of w_light, reflected at a normal visible from w_eye: D / (4 A(w_eye))
    double pdf_eye;    // and of w_eye
};

// Both directions on the same side.
inline FacetReflection facet_reflection(const Microfacet& microfacet, const Vec3& w_eye, const Vec3& w_light) {
    const Vec3 h = w_eye + w_light;
    const double length = h.norm();  // 2 w.m
    if (!(length > 0)) return {0, 0, 0, 0};
    const double d = 0.25 * microfacet.density(h / length);
    const double inv_eye = 1 / microfacet.projected_area(w_eye), inv_light = 1 / microfacet.projected_area(w_light);
    return {0.5 * length, d * inv_eye * inv_light, d * inv_eye, d * inv_light};
}

}  // namespace keyhole
