#include "compare/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/vec.h"

namespace keyhole {
namespace {

// The pixels that are compared, and the mean of their reference values.
struct Selection {
    std::vector<std::size_t> pixels;
    std::size_t masked = 0, non_finite = 0;
    double mean_reference = 0;
};

const float* values(const Image& image, std::size_t pixel) { return &image.rgb[3 * pixel]; }

bool finite(const float* v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

std::string size_text(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

void require_equal_size(const Image& a, const Image& reference, const char* what) {
    if (a.width != reference.width || a.height != reference.height)
        throw InputError({}, std::string(what) + " is " + size_text(a) + " pixels and the reference is " +
                                 size_text(reference) + "; they must be equal");
}

Selection select(const Image& image, const Image& reference, const Image* mask) {
    require_equal_size(image, reference, "the image");
    if (mask) require_equal_size(*mask, reference, "the mask");
    Selection selection;
    for (std::size_t i = 0; i < reference.rgb.size() / 3; ++i) {
        if (mask && std::all_of(values(*mask, i), values(*mask, i) + 3, [](float v) { return v == 0; })) {
            ++selection.masked;
        } else if (!finite(values(image, i)) || !finite(values(reference, i))) {
            ++selection.non_finite;
        } else {
            selection.pixels.push_back(i);
            selection.mean_reference += std::accumulate(values(reference, i), values(reference, i) + 3, 0.0);
        }
    }
    if (selection.pixels.empty()) throw InputError({}, "no pixel is left to compare");
    selection.mean_reference /= 3 * static_cast<double>(selection.pixels.size());
    return selection;
}

// a / b with 0 / 0 = 0: no error where there is nothing to be wrong about.
double ratio(double a, double b) { return a == 0 ? 0 : a / b; }

double relative_denominator(double r, double mean_reference) { return sqr(r) + metric_epsilon * sqr(mean_reference); }

// Mean over the channels of (I-R)^2 / (R^2 + epsilon mean(R)^2).
double relative_squared_error(const float* i, const float* r, double mean_reference) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += ratio(sqr(double{i[c]} - r[c]), relative_denominator(r[c], mean_reference));
    return sum / 3;
}

double mean_without_largest(std::vector<double> errors) {
    const auto removed = static_cast<std::ptrdiff_t>(trimmed_fraction * static_cast<double>(errors.size()));
    const auto kept_end = errors.end() - removed;
    if (removed > 0) std::nth_element(errors.begin(), kept_end, errors.end());
    return std::accumulate(errors.begin(), kept_end, 0.0) / static_cast<double>(kept_end - errors.begin());
}

constexpr std::array metrics = {
    MetricInfo{"mse", "mean((I-R)^2)", &ErrorMetrics::mse},
    MetricInfo{"rmse", "sqrt(mean((I-R)^2))", &ErrorMetrics::rmse},
    MetricInfo{"rrmse", "sqrt(mean((I-R)^2 / (R^2 + 0.001 mean(R)^2)))", &ErrorMetrics::rrmse},
    MetricInfo{"relmse_trimmed",
               "mean((I-R)^2 / (R^2 + 0.001 mean(R)^2)) without the 0.1% of pixels where it is largest",
               &ErrorMetrics::relmse_trimmed},
    MetricInfo{"mape", "mean(|I-R| / sqrt(R^2 + 0.001 mean(R)^2))", &ErrorMetrics::mape},
    MetricInfo{"smape", "mean(2 |I-R| / (|I| + |R|))", &ErrorMetrics::smape},
    MetricInfo{"mean_ratio", "mean(I) / mean(R)", &ErrorMetrics::mean_ratio_total},
};
static_assert(metric_epsilon == 0.001 && trimmed_fraction == 0.001, "the formulas above name them");

}  // namespace

std::span<const MetricInfo> metric_list() { return metrics; }

ErrorMetrics compare_images(const Image& image, const Image& reference, const Image* mask) {
    const Selection selection = select(image, reference, mask);
    ErrorMetrics m;
    m.pixels = selection.pixels.size();
    m.masked = selection.masked;
    m.non_finite = selection.non_finite;
    std::vector<double> relative;
    relative.reserve(m.pixels);
    for (const std::size_t pixel : selection.pixels) {
        const float *i = values(image, pixel), *r = values(reference, pixel);
        for (int c = 0; c < 3; ++c) {
            const double difference = std::abs(double{i[c]} - r[c]);
            m.mse += sqr(difference);
            m.mape += ratio(difference, std::sqrt(relative_denominator(r[c], selection.mean_reference)));
            m.smape += ratio(2 * difference, std::abs(double{i[c]}) + std::abs(double{r[c]}));
            m.mean[c] += i[c];
            m.mean_reference[c] += r[c];
        }
        relative.push_back(relative_squared_error(i, r, selection.mean_reference));
    }
    const double count = static_cast<double>(m.pixels);
    m.mean_ratio_total = m.mean.sum() / m.mean_reference.sum();
    m.mean_ratio = m.mean / m.mean_reference;
    m.mean /= count;
    m.mean_reference /= count;
    m.mse /= 3 * count;
    m.mape /= 3 * count;
    m.smape /= 3 * count;
    m.rmse = std::sqrt(m.mse);
    m.rrmse = std::sqrt(std::accumulate(relative.begin(), relative.end(), 0.0) / count);
    m.relmse_trimmed = mean_without_largest(std::move(relative));
    return m;
}

std::vector<double> relative_errors(const Image& image, const Image& reference, const Image* mask) {
    const Selection selection = select(image, reference, mask);
    std::vector<double> errors(reference.rgb.size() / 3, std::numeric_limits<double>::quiet_NaN());
    for (const std::size_t i : selection.pixels)
        errors[i] = std::sqrt(relative_squared_error(values(image, i), values(reference, i), selection.mean_reference));
    return errors;
}

}  // namespace keyhole
