// Fresnel equations for unpolarised light, and the directions that belong to them.
//
// `eta` is always relative: the index of refraction on the far side over the one on the side of the given direction.
// Cosines are measured on the side of the given direction and lie in [0, 1]. The formulas are the rationalised ones:
// no differences of nearly equal numbers, so they hold at grazing angles, at the critical angle and for eta near 1.
#pragma once

#include <cmath>

#include "base/frame.h"
#include "base/spectrum.h"
#include "base/vec.h"

namespace keyhole {

struct DielectricFresnel {
    double reflectance;
    double transmittance;  // 1 - reflectance without its cancellation; 0 under total internal reflection
    double cos_t;          // cosine of the refracted direction, >= 0; 0 under total internal reflection
};

// With q = eta cos_t = sqrt(cos^2 + eta^2 - 1) [Born and Wolf 1999, 1.5.2]:
//   r_s = (cos - q) / (cos + q)                 = (1 - eta^2) / (cos + q)^2
//   r_p = (eta^2 cos - q) / (eta^2 cos + q)     = (eta^2 - 1) ((eta^2 + 1) cos^2 - 1) / (eta^2 cos + q)^2
inline DielectricFresnel fresnel_dielectric(double cos_i, double eta) {
    const double eta2 = eta * eta, d = (eta - 1) * (eta + 1), q2 = cos_i * cos_i + d;
    if (q2 < 0 || cos_i <= 0) return {1, 0, safe_sqrt(q2) / eta};
    const double q = std::sqrt(q2);
    const double inv_s = 1 / (cos_i + q), inv_p = 1 / (eta2 * cos_i + q);
    const double r_s = d * inv_s * inv_s, r_p = d * ((eta2 + 1) * cos_i * cos_i - 1) * inv_p * inv_p;
    return {0.5 * (r_s * r_s + r_p * r_p), 2 * cos_i * q * (inv_s * inv_s + eta2 * inv_p * inv_p), q / eta};
}

// Reflectance of an absorbing medium of relative index eta + i k, one channel and per channel. eta = 0 with k > 0 is a
// perfect mirror; cos_i = 0 reflects all.
double fresnel_conductor(double cos_i, double eta, double k);
Spectrum fresnel_conductor(double cos_i, const Spectrum& eta, const Spectrum& k);

// Share of cosine-weighted (diffuse) light that a smooth dielectric boundary reflects: the integral of
// 2 cos F(cos) dcos over [0, 1]. eta > 1: from outside; eta < 1: from inside. Relative error below 1e-10. Slow.
double fresnel_diffuse_reflectance(double eta);

// The mirror direction about +z, and about the unit vector `m` (either orientation).
inline Vec3 reflect(const Vec3& w) { return {-w.x(), -w.y(), w.z()}; }
inline Vec3 reflect(const Vec3& w, const Vec3& m) { return 2 * w.dot(m) * m - w; }

// The refracted direction, on the other side of the plane; `cos_t` from fresnel_dielectric, which must not have
// reported total internal reflection. About +z, and about the unit vector `m` (either orientation).
inline Vec3 refract(const Vec3& w, double cos_t, double eta) {
    const double inv_eta = 1 / eta;
    return {-w.x() * inv_eta, -w.y() * inv_eta, -std::copysign(cos_t, w.z())};
}
inline Vec3 refract(const Vec3& w, const Vec3& m, double cos_t, double eta) {
    const double inv_eta = 1 / eta, cos_i = w.dot(m);
    return m * (cos_i * inv_eta - std::copysign(cos_t, cos_i)) - w * inv_eta;
}

}  // namespace keyhole
