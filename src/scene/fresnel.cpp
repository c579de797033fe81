#include "scene/fresnel.h"

#include <array>

namespace keyhole {
namespace {

// numerator / denominator of two sums of squares with numerator <= denominator; 0/0 is the limit of full reflection.
double ratio(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 1; }

// The integral for eta > 1. With cos = kappa sinh(x), kappa^2 = eta^2 - 1, the square root q of fresnel_dielectric
// becomes kappa cosh(x) and the integrand smooth; x = end t^2 crowds the nodes at x = 0, near the pole of the p term.
double diffuse_reflectance_outside(double eta) {
    constexpr std::array<double, 5> node = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                            0.9061798459386640};
    constexpr std::array<double, 5> weight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                              0.4786286704993665, 0.2369268850561891};
    constexpr int panels = 64;
    constexpr double half = 0.5 / panels;
    const double kappa = std::sqrt((eta - 1) * (eta + 1)), end = std::asinh(1 / kappa);
    double sum = 0;
    for (int i = 0; i < panels; ++i)
        for (std::size_t j = 0; j < node.size(); ++j) {
            const double t = (2 * i + 1 + node[j]) * half, c = kappa * std::sinh(end * t * t);
            const double dc = std::hypot(kappa, c) * 2 * end * t;
            sum += weight[j] * 2 * c * fresnel_dielectric(c, eta).reflectance * dc;
        }
    return sum * half;
}

}  // namespace

// With sqrt((eta + i k)^2 - sin^2) = a + i b [Born and Wolf 1999, 14.2]:
//   R_s = ((a - cos)^2 + b^2) / ((a + cos)^2 + b^2)
//   R_p = R_s ((a cos - sin^2)^2 + b^2 cos^2) / ((a cos + sin^2)^2 + b^2 cos^2)
double fresnel_conductor(double cos_i, double eta, double k) {
    const double cos2 = cos_i * cos_i, sin2 = (1 - cos_i) * (1 + cos_i);
    const double real = (eta - k) * (eta + k) - sin2, imaginary = 2 * eta * k;
    // The larger of a and b by a sum, the other from 2 a b = imaginary part.
    const double larger = std::sqrt(0.5 * (std::sqrt(real * real + imaginary * imaginary) + std::abs(real)));
    const double smaller = larger > 0 ? 0.5 * imaginary / larger : 0;
    const double a = real >= 0 ? larger : smaller, b2 = real >= 0 ? smaller * smaller : larger * larger;
    const double r_s = ratio(sqr(a - cos_i) + b2, sqr(a + cos_i) + b2);
    const double r_p = r_s * ratio(sqr(a * cos_i - sin2) + b2 * cos2, sqr(a * cos_i + sin2) + b2 * cos2);
    return 0.5 * (r_s + r_p);
}

Spectrum fresnel_conductor(double cos_i, const Spectrum& eta, const Spectrum& k) {
    return {fresnel_conductor(cos_i, eta[0], k[0]), fresnel_conductor(cos_i, eta[1], k[1]),
            fresnel_conductor(cos_i, eta[2], k[2])};
}

double fresnel_diffuse_reflectance(double eta) {
    if (eta == 1) return 0;
    if (eta > 1) return diffuse_reflectance_outside(eta);
    // Reciprocity of the boundary: (1 - inside) = eta^2 (1 - outside) with the basic radiance conserved.
    return 1 - eta * eta * (1 - diffuse_reflectance_outside(1 / eta));
}

}  // namespace keyhole
