// Independent renders of one scene, compared pixel by pixel.
//
// The z-test: n renders with different seeds give each pixel a mean and a standard error; two estimators' means of every
// pixel must agree by Welch's t-test at a Sidak-corrected level, and so must the means of the whole image.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "render/render.h"
#include "statistics.h"

namespace keyhole {

// Sums and squares of luminance by pixel; the last entry is the mean of the image.
struct Replicates {
    int n = 0, width = 0, height = 0;
    std::vector<double> sum, squares;

    void add(const Image& image) {
        width = image.width;
        height = image.height;
        const std::size_t pixels = static_cast<std::size_t>(width) * height;
        sum.resize(pixels + 1);
        squares.resize(pixels + 1);
        double mean = 0;
        const auto add_value = [&](std::size_t i, double v) {
            sum[i] += v;
            squares[i] += v * v;
        };
        for (std::size_t i = 0; i < pixels; ++i) {
            const double v = luminance({image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]});
            add_value(i, v);
            mean += v / static_cast<double>(pixels);
        }
        add_value(pixels, mean);
        ++n;
    }
    double mean(std::size_t i) const { return sum[i] / n; }
    // Of mean(i).
    double variance(std::size_t i) const {
        return std::max(0.0, squares[i] / n - mean(i) * mean(i)) / (n - 1);
    }
};

inline Replicates render_replicates(const Scene& scene, RenderSettings settings, int runs) {
    Replicates replicates;
    for (int i = 0; i < runs; ++i) {
        settings.mix.seed = 1000 + static_cast<std::uint64_t>(i);
        const RenderResult result = render(scene, settings);
        EXPECT_EQ(result.statistics.non_finite, 0u);
        replicates.add(result.image);
    }
    return replicates;
}

// Welch's two-sided p-value; 1 where neither varies and both agree.
inline double welch_p_value(const Replicates& a, const Replicates& b, std::size_t i) {
    const double va = a.variance(i), vb = b.variance(i), difference = a.mean(i) - b.mean(i);
    // What single precision leaves of the mean is not noise.
    const double rounding = 1e-6 * std::abs(a.mean(i));
    if (std::abs(difference) <= rounding) return 1;
    if (!(va + vb > 0)) return 0;
    const double t = difference / std::sqrt(va + vb);
    const double degrees = (va + vb) * (va + vb) / (va * va / (a.n - 1) + vb * vb / (b.n - 1));
    return student_two_sided_tail(t, std::max(1.0, degrees));
}

struct Agreement {
    double smallest_pixel_p = 1;  // to be held against sidak_level(family, pixels)
    double mean_p = 1;            // of the whole image
    double mean_ratio = 1;
    std::size_t worst = 0;
};

inline Agreement compare(const Replicates& a, const Replicates& b) {
    Agreement result;
    const std::size_t pixels = a.sum.size() - 1;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double p = welch_p_value(a, b, i);
        if (p < result.smallest_pixel_p) {
            result.smallest_pixel_p = p;
            result.worst = i;
        }
    }
    result.mean_p = welch_p_value(a, b, pixels);
    result.mean_ratio = a.mean(pixels) / b.mean(pixels);
    return result;
}

inline Image mean_image(const Replicates& r) {
    Image image(r.width, r.height);
    for (std::size_t i = 0; i + 1 < r.sum.size(); ++i)
        for (int c = 0; c < 3; ++c) image.rgb[3 * i + c] = static_cast<float>(r.mean(i));
    return image;
}

// Expects agreement at a false-alarm level of `level` for this call. Saves both means on failure.
inline void expect_agreement(const Replicates& a, const Replicates& b, double level, const std::string& what) {
    const Agreement r = compare(a, b);
    const int pixels = static_cast<int>(a.sum.size()) - 1;
    const bool pixels_agree = r.smallest_pixel_p > sidak_level(level / 2, pixels), means_agree = r.mean_p > level / 2;
    EXPECT_TRUE(pixels_agree) << what << ": p = " << r.smallest_pixel_p << " in pixel (" << r.worst % a.width << ", "
                              << r.worst / a.width << "), means " << a.mean(r.worst) << " and " << b.mean(r.worst);
    EXPECT_TRUE(means_agree) << what << ": p = " << r.mean_p << ", ratio of means " << r.mean_ratio;
    if (pixels_agree && means_agree) return;
    write_image(what + "-a.exr", mean_image(a));
    write_image(what + "-b.exr", mean_image(b));
    ADD_FAILURE() << "the means are in " << what << "-a.exr and -b.exr";
}

}  // namespace keyhole
