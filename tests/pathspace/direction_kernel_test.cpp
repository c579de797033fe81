// The kernel of directions against its density.
#include "pathspace/direction_kernel.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "statistics.h"

namespace keyhole {
namespace {

// Chi-square of the angle and the azimuth, in cells of equal numbers by the integral of the density over solid angle.
TEST(DirectionKernel, FollowsItsDensity) {
    constexpr int samples = 40000, rings = 12, sectors = 6;
    Rng rng(3, 1);
    for (const DirectionKernel kernel : {DirectionKernel{1e-4, 1e-2}, {0.05, 0.5}, {0.3, 1.4}})
        for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0.6, -0.48, 0.64), Vec3(0, 0, -1)}) {
            std::vector<double> observed(rings * sectors, 0), expected;
            // Integral of pdf 2 pi sin(theta) over a ring, by the midpoint rule in the logarithm of the angle.
            const double step = std::log(kernel.r_max / kernel.r_min) / rings;
            double total = 0;
            for (int ring = 0; ring < rings; ++ring) {
                double mass = 0;
                for (int i = 0; i < 200; ++i) {
                    const double theta = kernel.r_min * std::exp(step * (ring + (i + 0.5) / 200));
                    mass += std::exp(kernel.log_pdf(theta)) * 2 * pi * std::sin(theta) * theta * step / 200;
                }
                total += mass;
                for (int s = 0; s < sectors; ++s) expected.push_back(samples * mass / sectors);
            }
            EXPECT_NEAR(total, 1, 1e-6);
            const Frame frame = Frame::from_normal(axis);
            for (int i = 0; i < samples; ++i) {
                const double first = rng.uniform();
                const Vec3 d = kernel.sample(axis, {first, rng.uniform()});
                ASSERT_NEAR(d.norm(), 1, 1e-14);
                const double theta = angle_between(axis, d);
                ASSERT_GT(kernel.log_pdf(theta), -1e300) << theta;
                const Vec3 local = frame.to_local(d);
                const double phi = std::atan2(local.y(), local.x()) / (2 * pi) + 0.5;
                const int ring = std::clamp(static_cast<int>(std::log(theta / kernel.r_min) / step), 0, rings - 1);
                ++observed[static_cast<std::size_t>(ring * sectors +
                                                    std::min(sectors - 1, static_cast<int>(phi * sectors)))];
            }
            EXPECT_GT(chi_square_p_value(expected, observed), 1e-4);
            EXPECT_EQ(kernel.log_pdf(0.9 * kernel.r_min), -std::numeric_limits<double>::infinity());
            EXPECT_EQ(kernel.log_pdf(1.1 * kernel.r_max), -std::numeric_limits<double>::infinity());
        }
}

}  // namespace
}  // namespace keyhole
