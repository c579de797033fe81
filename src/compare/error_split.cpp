#include "compare/error_split.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"
#include "base/vec.h"
#include "compare/metrics.h"

namespace keyhole {
namespace {

// w of each value; 0 where it is left out.
std::vector<double> weights(std::span<const Image> runs, const Image& reference, const Image* variance) {
    const std::size_t pixels = reference.rgb.size() / 3;
    std::vector<double> w(reference.rgb.size(), 0.0);
    double sum = 0, count = 0;
    const auto finite = [](const Image& image, std::size_t pixel) {
        const float* v = &image.rgb[3 * pixel];
        return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    };
    for (std::size_t i = 0; i < pixels; ++i) {
        bool all = finite(reference, i) && (!variance || finite(*variance, i));
        for (const Image& run : runs) all = all && finite(run, i);
        if (!all) continue;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            w[c] = 1;
            sum += reference.rgb[c];
            ++count;
        }
    }
    if (count == 0) throw std::runtime_error("no pixel is left to compare");
    const double floor = metric_epsilon * sqr(sum / count);
    for (std::size_t i = 0; i < w.size(); ++i)
        if (w[i] > 0) {
            const double denominator = sqr(double{reference.rgb[i]}) + floor;
            w[i] = denominator > 0 ? 1 / (denominator * count) : 0;
        }
    return w;
}

// Sums over values, of all runs and with each run left out.
struct Sums {
    double variance = 0, squared_bias = 0;
    std::vector<double> variance_without, squared_bias_without;

    explicit Sums(std::size_t runs) : variance_without(runs, 0.0), squared_bias_without(runs, 0.0) {}

    void operator+=(const Sums& other) {
        variance += other.variance;
        squared_bias += other.squared_bias;
        for (std::size_t r = 0; r < variance_without.size(); ++r) {
            variance_without[r] += other.variance_without[r];
            squared_bias_without[r] += other.squared_bias_without[r];
        }
    }
};

}  // namespace

ErrorSplit split_error(std::span<const Image> runs, const Image& reference, const Image* reference_variance) {
    const double n = static_cast<double>(runs.size());
    const std::vector<double> w = weights(runs, reference, reference_variance);
    std::vector<Sums> rows(static_cast<std::size_t>(reference.height), Sums(runs.size()));
    const std::size_t row_length = 3 * static_cast<std::size_t>(reference.width);
    parallel_for(rows.size(), [&](std::size_t y) {
        Sums& sums = rows[y];
        std::vector<double> x(runs.size());
        for (std::size_t i = y * row_length; i < (y + 1) * row_length; ++i) {
            if (w[i] == 0) continue;
            double mean = 0, squares = 0;
            for (std::size_t r = 0; r < runs.size(); ++r) mean += x[r] = runs[r].rgb[i];
            mean /= n;
            for (const double v : x) squares += sqr(v - mean);
            const double noise = reference_variance ? reference_variance->rgb[i] : 0;
            const double error = mean - reference.rgb[i], variance = squares / (n - 1);
            sums.variance += w[i] * variance;
            sums.squared_bias += w[i] * (sqr(error) - variance / n - noise);
            if (runs.size() < 3) continue;
            for (std::size_t r = 0; r < runs.size(); ++r) {
                const double d = x[r] - mean;
                const double variance_r = (squares - n / (n - 1) * sqr(d)) / (n - 2);
                sums.variance_without[r] += w[i] * variance_r;
                sums.squared_bias_without[r] += w[i] * (sqr(error - d / (n - 1)) - variance_r / (n - 1) - noise);
            }
        }
    });
    Sums all(runs.size());
    for (const Sums& row : rows) all += row;
    return {jackknife(all.variance, all.variance_without), jackknife(all.squared_bias, all.squared_bias_without)};
}

double reference_relmse(const Image& reference, const Image& reference_variance) {
    const std::vector<double> w = weights({}, reference, &reference_variance);
    double sum = 0;
    for (std::size_t i = 0; i < w.size(); ++i)
        if (w[i] > 0) sum += w[i] * reference_variance.rgb[i];
    return sum;
}

}  // namespace keyhole
