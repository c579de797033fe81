#include "scene/reader/cie.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

constexpr double first = 360, last = 830, step = 1;  // nm, where the colour matching functions are not zero

double lobe(double x, double mean, double left, double right) {
    return std::exp(-0.5 * sqr((x - mean) / (x < mean ? left : right)));
}

Vec3 integrate(const std::function<double(double)>& spectrum) {
    Vec3 sum(0, 0, 0);
    for (double x = first; x <= last; x += step) sum += spectrum(x) * cie_xyz(x) * step;
    return sum;
}

}  // namespace

Vec3 cie_xyz(double x) {
    return {
        1.056 * lobe(x, 599.8, 37.9, 31.0) + 0.362 * lobe(x, 442.0, 16.0, 26.7) - 0.065 * lobe(x, 501.1, 20.4, 26.2),
        0.821 * lobe(x, 568.8, 46.9, 40.5) + 0.286 * lobe(x, 530.9, 16.3, 31.1),
        1.217 * lobe(x, 437.0, 11.8, 36.0) + 0.681 * lobe(x, 459.0, 26.0, 13.8)};
}

double cie_d65(double nanometres) {
    // CIE 015, every 10 nm from 300 nm.
    static constexpr std::array<double, 54> power = {
        0.0341,  3.2945,  20.236,  37.0535, 39.9488, 44.9117, 46.6383, 52.0891, 49.9755, 54.6482, 82.7549,
        91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
        104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987,
        83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856,
        75.087,  63.5927, 46.4182, 66.8054, 63.3828, 64.304,  59.4519, 51.959,  57.4406, 60.3125};
    const double at = (nanometres - 300) / 10;
    if (!(at >= 0 && at <= static_cast<double>(power.size() - 1))) return 0;
    const auto i = std::min(static_cast<std::size_t>(at), power.size() - 2);
    const double t = at - static_cast<double>(i);
    return (1 - t) * power[i] + t * power[i + 1];
}

Spectrum xyz_to_rgb(const Vec3& c) {
    // Rec. 709 primaries and D65 white, as in IEC 61966-2-1.
    return {3.240479 * c.x() - 1.537150 * c.y() - 0.498535 * c.z(),
            -0.969256 * c.x() + 1.875991 * c.y() + 0.041556 * c.z(),
            0.055648 * c.x() - 0.204043 * c.y() + 1.057311 * c.z()};
}

double SampledSpectrum::operator()(double x) const {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(wavelengths.begin(), wavelengths.end(), x) - wavelengths.begin());
    if (after == 0) return values.front();
    if (after == values.size()) return values.back();
    const double t = (x - wavelengths[after - 1]) / (wavelengths[after] - wavelengths[after - 1]);
    return (1 - t) * values[after - 1] + t * values[after];
}

Spectrum reflected_rgb(const std::function<double(double)>& spectrum) {
    static const Spectrum white = xyz_to_rgb(integrate(cie_d65));
    return xyz_to_rgb(integrate([&](double x) { return spectrum(x) * cie_d65(x); })) / white;
}

Spectrum emitted_rgb(const std::function<double(double)>& spectrum) {
    static const double efficiency = integrate([](double) { return 1.0; }).y();
    return xyz_to_rgb(integrate(spectrum) / efficiency);
}

double planck(double nanometres, double kelvin) {
    constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    const double x = nanometres * 1e-9;
    return 2 * h * c * c / (std::pow(x, 5) * std::expm1(h * c / (x * k * kelvin))) * 1e-9;
}

}  // namespace keyhole
