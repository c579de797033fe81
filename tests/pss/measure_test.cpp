// What moves in path space know of a path, against the definitions and against the charts that made it.
#include "pathspace/measure.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "closed_room.h"
#include "own_scenes.h"
#include "pss/chart.h"

namespace keyhole {
namespace {

constexpr int max_length = 6;

class Measure : public testing::TestWithParam<TransportCase> {};

// f and all densities are those of pathspace/path.h, and C and the weights those of the chart that the path came from,
// whichever technique it is taken for now. Tolerances as in the test of charts.
TEST_P(Measure, IsThatOfThePathsChart) {
    const auto scene = own_scene(GetParam(), 16, 16);
    const CoordinateLayout layout(*scene, max_length);
    Chart chart(*scene, layout);
    SampledPath path;
    path.room.resize(max_length + 1);
    PathMeasure m(max_length);
    PrimarySample u(layout);
    Rng rng(7, 2);
    int found = 0;
    for (int i = 0; i < 60000; ++i) {
        u.k = 1 + static_cast<int>(rng.below(max_length));
        u.t = u.k == 1 ? 2 : 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(u.k) + 1));
        for (double& c : u.coordinates) c = rng.uniform();
        const Evaluation e = chart.evaluate(u, path);
        if (e.failure != PathFailure::none || !(e.target > 1e-15)) continue;
        ++found;
        ASSERT_EQ(measure(*scene, chart.window(), TargetFunction::luminance, path.x(), m), PathFailure::none);
        const Path whole = join(path.eye(), path.light());
        const Spectrum f = contribution(*scene, whole);
        ASSERT_NEAR(std::exp(m.log_f) / luminance(f), 1, 1e-9);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(m.color[c], f[c] / luminance(f), 1e-9);
        const PathDensities p = densities(*scene, chart.window(), whole);
        for (int j = 0; j <= u.k; ++j) {
            const auto at = static_cast<std::size_t>(j);
            ASSERT_NEAR(m.eye[at], p.eye[at], 1e-9 * p.eye[at]) << j;
            ASSERT_NEAR(m.light[at], p.light[at], 1e-9 * p.light[at]) << j;
        }
        ASSERT_LE((m.raster - e.raster).norm(), 1e-6);
        std::vector<double> weights(static_cast<std::size_t>(u.k) + 1), again(weights);
        mis_weights(path.eye(), path.light(), path.junction, all_techniques, weights);
        ASSERT_NEAR(adopt_technique(all_techniques, m, path) / e.target, 1, 1e-6) << "k " << u.k << ", t " << u.t;
        mis_weights(path.eye(), path.light(), path.junction, all_techniques, again);
        for (std::size_t t = 0; t < weights.size(); ++t) ASSERT_NEAR(weights[t], again[t], 1e-6);
        ASSERT_NEAR(path.weight, again[static_cast<std::size_t>(path.t) - 1], 1e-12);
    }
    EXPECT_GT(found, 100);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Measure, testing::ValuesIn(transport_cases()), test_name_of_case);

// f of 64 edges, in a room so small or so large that f leaves the range of double.
TEST(LongPaths, AreMeasuredInScenesOfAnySize) {
    constexpr int length = 64;
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const auto scene = closed_room(scale);
        const CoordinateLayout layout(*scene, length);
        Chart chart(*scene, layout);
        SampledPath path;
        path.room.resize(length + 1);
        PathMeasure m(length);
        PrimarySample u(layout);
        u.k = length;
        Rng rng(3, 3);
        int found = 0;
        for (int i = 0; i < 20000 && found < 200; ++i) {
            u.t = 1 + static_cast<int>(rng.below(length + 1));
            for (double& c : u.coordinates) c = rng.uniform();
            const Evaluation e = chart.evaluate(u, path);
            if (e.failure != PathFailure::none || !(e.target > 0)) continue;
            ++found;
            ASSERT_EQ(measure(*scene, chart.window(), TargetFunction::luminance, path.x(), m), PathFailure::none);
            ASSERT_TRUE(std::isfinite(m.log_f));
            ASSERT_NEAR(adopt_technique(all_techniques, m, path) / e.target, 1, 1e-5);
        }
        EXPECT_EQ(found, 200) << "scale " << scale;
    }
}

}  // namespace
}  // namespace keyhole
