// How far an image is from a reference. All sums are in double precision.
//
// I is a value of the image, R of the reference; "values" are the three channels of all compared pixels, and mean(R) is
// the mean of the reference's values. The relative metrics divide by sqrt(R^2 + epsilon mean(R)^2), so black parts of
// the reference count, but not without bound, and scaling both images changes nothing.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/spectrum.h"
#include "render/image.h"

namespace keyhole {

inline constexpr double metric_epsilon = 1e-3;
inline constexpr double trimmed_fraction = 1e-3;

struct ErrorMetrics {
    std::size_t pixels = 0;      // compared
    std::size_t masked = 0;      // left out because the mask is black there
    std::size_t non_finite = 0;  // left out because a value of either image is not finite
    double mse = 0, rmse = 0;
    double rrmse = 0;
    double relmse_trimmed = 0;  // without the floor(pixels * trimmed_fraction) pixels of largest relative squared error
    double mape = 0, smape = 0;
    Spectrum mean = Spectrum::Zero(), mean_reference = Spectrum::Zero();
    Spectrum mean_ratio = Spectrum::Zero();  // per channel
    double mean_ratio_total = 0;             // over all values
};

// Throws InputError if the sizes differ, and if no pixel is left to compare. `mask` may be null.
ErrorMetrics compare_images(const Image& image, const Image& reference, const Image* mask = nullptr);

struct MetricInfo {
    const char* name;     // on the command line and in JSON
    const char* formula;  // as printed
    double ErrorMetrics::*value;
};
// The scalar metrics, in the order in which they are reported.
std::span<const MetricInfo> metric_list();

// Per pixel, row by row: sqrt of the mean over the channels of (I-R)^2 / (R^2 + epsilon mean(R)^2); NaN where
// compare_images leaves a pixel out. Its square averages to rrmse^2.
std::vector<double> relative_errors(const Image& image, const Image& reference, const Image* mask = nullptr);

}  // namespace keyhole
