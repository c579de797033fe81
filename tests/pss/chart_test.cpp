// Every technique's chart against the one definition of f and of the densities.
#include "pss/chart.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "own_scenes.h"
#include "pathspace/path.h"

namespace keyhole {
namespace {

constexpr int max_length = 6;

// Calls body(u, path, densities, evaluation) for paths drawn by all techniques of lengths 1 to max_length.
template <class Body>
int for_sampled_paths(const Scene& scene, int tries, const Body& body) {
    const CoordinateLayout layout(scene, max_length);
    Chart chart(scene, layout);
    Rng rng(7, 1);
    int found = 0;
    for (int i = 0; i < tries; ++i) {
        PrimarySample u(layout);
        u.k = 1 + static_cast<int>(rng.below(max_length));
        u.t = u.k == 1 ? 2 : 1 + static_cast<int>(rng.below(u.k + 1));
        for (double& c : u.coordinates) c = rng.uniform();
        const Evaluation e = chart.evaluate(u);
        EXPECT_NE(e.failure, PathFailure::non_finite);
        if (e.failure != PathFailure::none) continue;
        ++found;
        const Path path = join(chart.path().eye(), chart.path().light());
        body(u, path, densities(scene, chart.window(), path), e);
    }
    return found;
}

double path_density(const PathDensities& d, int t) {
    double p = 1;
    for (int i = 0; i < static_cast<int>(d.eye.size()); ++i) p *= i < t ? d.eye[i] : d.light[i];
    return p;
}

class Charts : public testing::TestWithParam<TransportCase> {};

// Weights by the recurrence equal p_t / sum p_t' from whole products of densities (short paths: no overflow), and
// C = f / sum p_t' whichever technique sampled the path. The tolerance covers the rounding of about 60 factors and of
// directions that are normalised again from positions. Far in the tail of a narrow lobe the exponent amplifies those
// without bound; such contributions are 1e-20 of the others and below, and are compared absolutely.
TEST_P(Charts, ContributionAndWeightsDoNotDependOnTheTechnique) {
    const auto scene = own_scene(GetParam(), 16, 16);
    const double tolerance = 1e-6, negligible = 1e-18;
    const int found = for_sampled_paths(
        *scene, 60000, [&](const PrimarySample& u, const Path& path, const PathDensities& d, const Evaluation& e) {
            double sum = 0;
            for (int t = 1; t <= u.k + 1; ++t)
                if (technique_exists(path.x, t)) sum += path_density(d, t);
            ASSERT_TRUE(technique_exists(path.x, u.t));
            const Spectrum expected = contribution(*scene, path) / sum;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(e.contribution[c], expected[c], tolerance * e.contribution.maxCoeff() + negligible)
                    << "k = " << u.k << ", t = " << u.t;
        });
    EXPECT_GT(found, 100);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Charts, testing::ValuesIn(transport_cases()), test_name_of_case);

}  // namespace
}  // namespace keyhole
