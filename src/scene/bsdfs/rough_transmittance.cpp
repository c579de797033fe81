#include "scene/bsdfs/rough_transmittance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/fresnel.h"
#include "scene/microfacet.h"

namespace keyhole {
namespace {

struct Node {
    double x, weight;
};

// Gauss-Legendre rule on [0, 1], nodes by Newton's method on the recurrence.
std::vector<Node> gauss_legendre(int n) {
    std::vector<Node> nodes;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(pi * (i + 0.75) / (n + 0.5)), derivative = 1;
        for (int step = 0; step < 8; ++step) {
            double p = 1, previous = 0;
            for (int k = 1; k <= n; ++k) previous = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * previous) / k);
            derivative = n * (x * p - previous) / (x * x - 1);
            x -= p / derivative;
        }
        nodes.push_back({0.5 * (1 + x), 1 / ((1 - x * x) * derivative * derivative)});
    }
    return nodes;
}

// One facet's share: (1 - F) G1 of the refracted direction, 0 if that does not cross the surface.
double facet_transmittance(const Microfacet& microfacet, double eta, const Vec3& w, const Vec2& u) {
    const Vec3 m = microfacet.sample_visible(w, u);
    const double cos_m = std::min(w.dot(m), 1.0);
    const DielectricFresnel fresnel = fresnel_dielectric(cos_m, eta);
    if (fresnel.transmittance <= 0) return 0;
    const Vec3 t = refract(w, m, fresnel.cos_t, eta);
    return t.z() < 0 ? fresnel.transmittance * microfacet.g1(t) : 0;
}

// Integral over the square of visible normals, triangle by triangle about its centre: the map is smooth in each, and
// mirrored at the plane of incidence. Radii crowd the rim, where the square's edge maps to steep facets.
double transmittance(const Microfacet& microfacet, double eta, double cos_theta, const std::vector<Node>& radii,
                     const std::vector<Node>& sides) {
    const Vec3 w(safe_sqrt(1 - cos_theta * cos_theta), 0, cos_theta);
    double sum = 0;
    for (const Node& radius : radii)
        for (const Node& side : sides) {
            const double rim = 1 - radius.x, r = 0.5 * (1 - rim * rim), s = r * side.x;
            const double facets = facet_transmittance(microfacet, eta, w, {0.5 + r, 0.5 + s}) +
                                  facet_transmittance(microfacet, eta, w, {0.5 - r, 0.5 + s}) +
                                  facet_transmittance(microfacet, eta, w, {0.5 + s, 0.5 + r}) +
                                  facet_transmittance(microfacet, eta, w, {0.5 - s, 0.5 + r});
            sum += 2 * r * rim * radius.weight * side.weight * facets;
        }
    return sum;
}

}  // namespace

RoughTransmittance::RoughTransmittance(MicrofacetType type, double alpha, double eta) {
    const Microfacet microfacet(type, alpha, alpha);
    const std::vector<Node> radii = gauss_legendre(16), sides = gauss_legendre(6);
    for (int i = 0; i <= intervals; ++i) {
        const double cos_theta = std::max(sqr(static_cast<double>(i) / intervals), 1e-8);
        values_[static_cast<std::size_t>(i) + 1] = transmittance(microfacet, eta, cos_theta, radii, sides);
    }
    const auto extrapolate = [](double a, double b, double c) { return 3 * (a - b) + c; };
    values_[0] = extrapolate(values_[1], values_[2], values_[3]);
    values_[intervals + 2] = extrapolate(values_[intervals + 1], values_[intervals], values_[intervals - 1]);

    // With cos = t^2 the integrand is a polynomial of degree 6 in every interval: four nodes are exact.
    double outwards = 0;
    for (const Node& node : gauss_legendre(4))
        for (int i = 0; i < intervals; ++i) {
            const double t = (i + node.x) / intervals;
            outwards += node.weight / intervals * 4 * t * t * t * (*this)(t * t);
        }
    internal_reflectance_ = 1 - outwards / (eta * eta);
}

// Cubic interpolation through four values [Catmull and Rom 1974] in sqrt(cos).
double RoughTransmittance::operator()(double cos_theta) const {
    const double t = std::sqrt(std::clamp(cos_theta, 0.0, 1.0)) * intervals;
    const int i = std::min(static_cast<int>(t), intervals - 1);
    const double x = t - i;
    const double* v = &values_[static_cast<std::size_t>(i)];
    const double slope0 = 0.5 * (v[2] - v[0]), slope1 = 0.5 * (v[3] - v[1]), rise = v[2] - v[1];
    const double share = v[1] + x * (slope0 + x * (3 * rise - 2 * slope0 - slope1 + x * (slope0 + slope1 - 2 * rise)));
    return std::clamp(share, 0.0, 1.0);  // interpolation may overshoot by 1e-6
}

std::shared_ptr<const RoughTransmittance> rough_transmittance(MicrofacetType type, double alpha, double eta) {
    static std::mutex mutex;
    static std::map<std::tuple<MicrofacetType, double, double>, std::weak_ptr<const RoughTransmittance>> tables;
    const std::lock_guard lock(mutex);
    auto& entry = tables[{type, alpha, eta}];
    auto table = entry.lock();
    if (!table) entry = table = std::make_shared<const RoughTransmittance>(type, alpha, eta);
    return table;
}

}  // namespace keyhole
