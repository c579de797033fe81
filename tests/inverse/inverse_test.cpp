// Inverses of whole paths: from any technique into any other and back.
#include "inverse/inverse.h"

#include <gtest/gtest.h>

#include <map>

#include "own_scenes.h"
#include "pathspace/path.h"
#include "statistics.h"

namespace keyhole {
namespace {

constexpr int max_length = 5;

class Inverses : public testing::TestWithParam<TransportCase> {
  protected:
    Inverses() : scene(own_scene(GetParam(), 16, 16)), layout(*scene, max_length), chart(*scene, layout) {}

    // Calls body(u, path, evaluation) for `wanted` paths of two edges or more with light, of all techniques.
    template <class Body>
    void for_paths(int wanted, const Body& body) {
        PrimarySample u(layout);
        for (int tries = 0; wanted > 0 && tries < 3000000; ++tries) {
            u.k = 2 + static_cast<int>(rng.below(max_length - 1));
            u.t = 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(u.k) + 1));
            for (double& c : u.coordinates) c = rng.uniform();
            const Evaluation e = chart.evaluate(u);
            if (e.failure != PathFailure::none || !(e.target > 0)) continue;
            --wanted;
            body(u, join(chart.path().eye(), chart.path().light()), e);
        }
        EXPECT_LE(wanted, 0) << "too few paths with light";
    }

    std::unique_ptr<Scene> scene;
    CoordinateLayout layout;
    Chart chart;
    Rng rng{5, 1};
};

// The re-traced path is the path, and as C does not depend on the technique, it is the same number. Failures are
// counted: rounding at the rim of a lobe or of the film may cause a few. Paths far in the tail of a narrow lobe, where
// numbers below one have no room left, carry nothing and are left out.
TEST_P(Inverses, EveryTechniqueGivesThePathBack) {
    std::map<InverseFailure, int> failures;
    int tries = 0;
    double worst = 0;
    PrimarySample other(layout);
    double mean_target = 0;
    for_paths(500, [&](const PrimarySample&, const Path&, const Evaluation& e) { mean_target += e.target / 500; });
    for_paths(2000, [&](const PrimarySample& u, const Path& path, const Evaluation& e) {
        if (e.target < 1e-7 * mean_target) return;
        for (int t = 1; t <= u.k + 1; ++t) {
            const InverseFailure failure = invert(*scene, chart.window(), layout, path.x, t, other, rng).failure;
            ASSERT_EQ(failure == InverseFailure::impossible, !technique_exists(path.x, t)) << u.k << ", " << t;
            if (failure == InverseFailure::impossible) continue;
            ++tries;
            if (failure != InverseFailure::none) {
                ++failures[failure];
                continue;
            }
            const Evaluation again = chart.evaluate(other);
            const double off = again.failure == PathFailure::none ? deviation(chart.path(), path.x) : 1e300;
            if (!(off < largest_deviation)) {
                ++failures[InverseFailure::retrace];
                continue;
            }
            worst = std::max(worst, off);
            // As far as the path itself is off.
            ASSERT_NEAR(again.target, e.target, (1e-6 + 100 * off) * e.target)
                << "k " << u.k << ", t " << u.t << " to " << t;
        }
    });
    int failed = 0;
    for (const auto& [kind, count] : failures) {
        failed += count;
        std::cout << "failure " << static_cast<int>(kind) << ": " << count << " of " << tries << "\n";
    }
    std::cout << "worst deviation " << worst << "\n";
    EXPECT_LE(failed, 0.002 * tries);
}

// Inverted into the technique that made it, a path gives coordinates of the same distribution: two-sample chi-square of
// each coordinate of paths of two edges with t = 2 or 3, in ten cells. False alarm: 1e-3 over all coordinates and
// scenes.
TEST_P(Inverses, CoordinatesHaveTheDistributionOfTheSamples) {
    std::vector<double> drawn(20 * 10), inverted(20 * 10);
    PrimarySample again(layout);
    int paths = 0;
    const auto count = [&](std::vector<double>& counts, const PrimarySample& u) {
        for (int i = 0; i < layout.count(u.k, u.t); ++i) {
            const double x = u.coordinates[static_cast<std::size_t>(i)];
            ++counts[static_cast<std::size_t>(10 * ((u.t - 1) % 2 * 10 + i) + static_cast<int>(10 * x))];
        }
    };
    for_paths(12000, [&](const PrimarySample& u, const Path& path, const Evaluation&) {
        if (u.k != 3 || (u.t != 2 && u.t != 3)) return;
        if (++paths % 2) return count(drawn, u);
        if (invert(*scene, chart.window(), layout, path.x, u.t, again, rng).failure == InverseFailure::none)
            count(inverted, again);
    });
    for (std::size_t c = 0; c < 20; ++c) {
        double chi_square = 0, sum_a = 0, sum_b = 0, cells = 0;
        for (std::size_t i = 10 * c; i < 10 * c + 10; ++i) {
            sum_a += drawn[i];
            sum_b += inverted[i];
        }
        if (sum_a < 50 || sum_b < 50) continue;
        for (std::size_t i = 10 * c; i < 10 * c + 10; ++i) {
            if (drawn[i] + inverted[i] < 10) continue;
            const double d = drawn[i] * std::sqrt(sum_b / sum_a) - inverted[i] * std::sqrt(sum_a / sum_b);
            chi_square += d * d / (drawn[i] + inverted[i]);
            ++cells;
        }
        if (cells < 2) continue;
        EXPECT_GT(chi_square_tail(chi_square, cells - 1), sidak_level(1e-3, 20 * 15)) << "coordinate " << c;
    }
}

// All own scenes but the one that has paths of a single edge only.
std::vector<TransportCase> cases() {
    std::vector<TransportCase> all = transport_cases();
    std::erase_if(all, [](const TransportCase& c) { return c.scene == "four-holes"; });
    return all;
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Inverses, testing::ValuesIn(cases()), test_name_of_case);

}  // namespace
}  // namespace keyhole
