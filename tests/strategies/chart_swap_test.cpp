// Chart swaps leave the joint distribution of path and technique alone.
#include "strategies/chart_swap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "own_scenes.h"
#include "statistics.h"

namespace keyhole {
namespace {

class ChartSwaps : public testing::TestWithParam<TransportCase> {};

// Large steps weighted by their estimates of b are distributed like the target pi(x, t). Swaps move each among the
// techniques of its path, so the weight that each technique holds stays what it was but for noise: the sum of the
// changes over its own spread is normal. Seen red with the ratio of densities left out (|z| up to 40 on the Cornell
// box).
TEST_P(ChartSwaps, KeepTheShareOfEachTechnique) {
    constexpr int max_length = 4, paths = 40000, swaps = 3, techniques_in_all = 12;
    const auto scene = own_scene(GetParam(), 16, 16);
    const CoordinateLayout layout(*scene, max_length);
    ChartEvaluator evaluator(*scene, layout, {}, {.path = true});
    const TechniqueDistribution techniques(2, max_length);
    const LargeStep large(evaluator, techniques);
    const ChartSwap swap(evaluator, techniques);
    Rng rng(3, 1);
    PssState x = evaluator.make_state(), y = evaluator.make_state();
    std::map<std::pair<int, int>, std::pair<double, double>> changes;  // by k and t: sum, sum of squares
    int moved = 0;
    for (int i = 0; i < paths; ++i) {
        large.draw(x, rng);
        if (!(x.target > 0)) continue;
        const double weight = large.estimate(x);
        const int k = x.u.k, before = x.u.t;
        for (int j = 0; j < swaps; ++j) {
            const Proposal p = swap.propose(x, y, rng);
            if (p.failure == Failure::none && rng.uniform() < p.ratio) std::swap(x, y);
        }
        if (x.u.t == before) continue;
        ++moved;
        for (const auto& [t, change] : {std::pair(before, -weight), std::pair(x.u.t, weight)}) {
            auto& [sum, squares] = changes[{k, t}];
            sum += change;
            squares += change * change;
        }
    }
    EXPECT_GT(moved, 1000);
    const double bound = normal_two_sided_quantile(sidak_level(1e-3, 3 * techniques_in_all));
    for (const auto& [technique, change] : changes)
        EXPECT_LT(std::abs(change.first) / std::sqrt(change.second), bound)
            << "k " << technique.first << ", t " << technique.second;
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, ChartSwaps,
                         testing::Values(TransportCase{"cornell-box"}, TransportCase{"glossy-room"},
                                         TransportCase{"keyhole-room", {{"hole", "0.4"}}}),
                         test_name_of_case);

}  // namespace
}  // namespace keyhole
