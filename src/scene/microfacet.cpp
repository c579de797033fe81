#include "scene/microfacet.h"

#include <algorithm>

#include "base/normal_quantile.h"
#include "base/warp.h"

namespace keyhole {
namespace {

// --- GGX, on the hemisphere of the unit-roughness configuration, seen from the unit vector w
// --------------------------
//
// A normal h is the half vector of w and a direction c uniform on the spherical cap c.z > -w.z. The cap is a disk under
// the equal-area projection |p|^2 = (1 - c.z) / (1 + w.z), c.xy = p sqrt((1 + w.z)(1 + c.z)).

Vec3 sample_ggx_hemisphere(const Vec3& w, const Vec2& u) {
    const Vec2 p = square_to_disk(u);
    const double height = 1 + w.z();
    // w.z + c.z without cancellation. On the disk's rim it is zero and the half vector may vanish: keep half an ulp.
    const double sum = height * std::max(1 - p.squaredNorm(), 0x1p-54);
    const double below_one = (w.x() * w.x() + w.y() * w.y()) / height;  // 1 - w.z
    const double scale = std::sqrt(height * (sum + below_one));
    return {w.x() + p.x() * scale, w.y() + p.y() * scale, sum};
}

Vec2 ggx_hemisphere_to_square(const Vec3& w, const Vec3& h) {
    const double height = 1 + w.z(), twice = 2 * w.dot(h) / h.squaredNorm();
    const double below_one = (w.x() * w.x() + w.y() * w.y()) / height;
    const double scale = std::sqrt(height * (twice * h.z() + below_one));
    if (!(scale > 0)) return {0, 0.5};
    return disk_to_square({(twice * h.x() - w.x()) / scale, (twice * h.y() - w.y()) / scale});
}

// --- Beckmann, slopes in the unit-roughness configuration
// -------------------------------------------------------------
//
// With the slope x along the azimuth of w, away from it, and y across, the visible slopes have the density
//     (c - s x) exp(-x^2 - y^2) / (pi A)   for x < c / s,   c = w.z, s = |w.xy| (w need not be a unit vector),
// so y is normal with variance 1/2 and x has the distribution function
//     H(x) = (c erfc(-x) + s exp(-x^2) / sqrt(pi)) / (2 A).

struct SlopeDistribution {
    double c, s, area;

    double cdf(double x) const {
        return (c * std::erfc(-x) + s * std::exp(-x * x) * std::numbers::inv_sqrtpi) / (2 * area);
    }
    double inverse(double u) const;
};

// Halley's method inside a bracket. It ends when the step predicts a cubic remainder below rounding, or at the rounding
// noise of H itself (near the horizon, where H is flat); three steps on average, 60 are never reached.
double SlopeDistribution::inverse(double u) const {
    u = std::max(u, 0x1p-54);
    const double horizon = s > 0 ? c / s : 9;
    double low = -9, high = std::min(horizon, 9.0);
    // Exact to first order in s / c, and good to a few tenths elsewhere.
    double x = normal_quantile(u) * (1 / std::numbers::sqrt2) - s / (2 * c + 1.2 * s);
    x = std::min(x, high - 0.05);
    for (int i = 0; i < 60; ++i) {
        const double e = std::exp(-x * x) * std::numbers::inv_sqrtpi;
        const double residual = (c * std::erfc(-x) + s * e) / (2 * area) - u;
        if (std::abs(residual) <= 1e-15 * u) break;
        (residual < 0 ? low : high) = x;
        const double slope = (c - s * x) * e / area, curvature = -2 * x - s / (c - s * x);
        const double newton = residual / slope, step = newton / (1 - 0.5 * newton * curvature);
        const double next = x - step;
        const bool converged = std::abs(step) < 1e-5 * std::min(1.0, horizon - x);
        x = converged || (next > low && next < high) ? next : 0.5 * (low + high);
        if (converged) break;
    }
    return x;
}

struct Azimuth {
    double x, y;
};

Azimuth azimuth(double x, double y, double length) {
    return length > 0 ? Azimuth{x / length, y / length} : Azimuth{1, 0};
}

}  // namespace

Vec3 Microfacet::sample_visible(const Vec3& w, const Vec2& u) const {
    const Vec3 stretched(alpha_x_ * w.x(), alpha_y_ * w.y(), w.z());
    if (type_ == MicrofacetType::ggx) {
        const Vec3 h = sample_ggx_hemisphere(stretched.normalized(), u);
        return Vec3(alpha_x_ * h.x(), alpha_y_ * h.y(), h.z()).normalized();
    }
    const double s = std::hypot(stretched.x(), stretched.y());
    const Azimuth towards = azimuth(stretched.x(), stretched.y(), s);
    const double x = SlopeDistribution{w.z(), s, beckmann_projected_area(w.z(), s)}.inverse(u.x());
    const double y = normal_quantile(u.y()) * (1 / std::numbers::sqrt2);
    return Vec3(-alpha_x_ * (towards.x * x + towards.y * y), -alpha_y_ * (towards.y * x - towards.x * y), 1)
        .normalized();
}

Vec2 Microfacet::visible_to_square(const Vec3& w, const Vec3& m) const {
    const Vec3 stretched(alpha_x_ * w.x(), alpha_y_ * w.y(), w.z());
    if (type_ == MicrofacetType::ggx)
        return ggx_hemisphere_to_square(stretched.normalized(), {m.x() * inv_alpha_x_, m.y() * inv_alpha_y_, m.z()});
    const double s = std::hypot(stretched.x(), stretched.y());
    const Azimuth towards = azimuth(stretched.x(), stretched.y(), s);
    const double slope_x = -m.x() * inv_alpha_x_ / m.z(), slope_y = -m.y() * inv_alpha_y_ / m.z();
    const double x = towards.x * slope_x + towards.y * slope_y, y = towards.y * slope_x - towards.x * slope_y;
    const SlopeDistribution slopes{w.z(), s, beckmann_projected_area(w.z(), s)};
    return {clamp01(slopes.cdf(x)), clamp01(normal_cdf(y * std::numbers::sqrt2))};
}

Roughness::Roughness(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v)
    : type_(type),
      alpha_u_(std::move(alpha_u)),
      alpha_v_(std::move(alpha_v)),
      constant_(type, alpha_u_.constant, alpha_v_.constant) {}

bool Roughness::anisotropic() const {
    return alpha_u_.texture != alpha_v_.texture || (!alpha_u_.texture && alpha_u_.constant != alpha_v_.constant);
}

}  // namespace keyhole
