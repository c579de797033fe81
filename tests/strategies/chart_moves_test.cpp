// Moves between the charts of a path, on the project's own scenes: what they know of its densities, and that they leave
// the joint distribution of path and technique alone.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "closed_room.h"
#include "own_scenes.h"
#include "statistics.h"
#include "strategies/chart_exchange.h"
#include "strategies/chart_swap.h"
#include "strategies/inverse_small_step.h"

namespace keyhole {
namespace {

constexpr int max_length = 5;

// Independent paths of two edges or more, on a scene.
class ChartMoves : public testing::TestWithParam<TransportCase> {
  protected:
    // Calls body(x, weight) with the paths with light among `tries`; so weighted, they are distributed like pi(x, t).
    // Those that carry nothing, far in the tails of narrow lobes, are left out: numbers below one have no room for
    // them.
    template <class Body>
    void for_paths(int tries, const Body& body) {
        double mean = 0;
        for (int i = 0; i < tries; ++i) {
            large.draw(x, rng);
            if (!(x.target > 0)) continue;
            const double weight = large.estimate(x);
            mean += (weight - mean) / (i + 1);
            if (weight > 1e-7 * mean) body(weight);
        }
    }

    std::unique_ptr<Scene> scene = own_scene(GetParam(), 16, 16);
    CoordinateLayout layout{*scene, max_length};
    ChartEvaluator charts{*scene, layout, {}, {.path = true, .forgets = true}};
    TechniqueDistribution techniques{2, max_length};
    LargeStep large{charts, techniques};
    PssState x = charts.make_state(), y = charts.make_state();
    Rng rng{3, 1};
};

// The same path by the definitions of pathspace/path.h: products of densities, which short paths allow.
struct ByDefinition {
    double target = 0;            // f*
    std::vector<double> weights;  // w_t, at t - 1

    ByDefinition(const Scene& scene, const RasterWindow& window, const SampledPath& sampled) {
        const Path path = join(sampled.eye(), sampled.light());
        target = scalar(TargetFunction::luminance, contribution(scene, path));
        const PathDensities p = densities(scene, window, path);
        double sum = 0;
        for (int t = 1; t <= path.length() + 1; ++t) {
            double product = technique_exists(path.x, t) ? 1 : 0;
            for (int i = 0; i <= path.length(); ++i) product *= (i < t ? p.eye : p.light)[static_cast<std::size_t>(i)];
            weights.push_back(product);
            sum += product;
        }
        for (double& w : weights) w /= sum;
    }
};

// The weights that a chart move reads, against products of densities and against those of the path traced again; and
// the ratio of the Gibbs move, computed from the definitions, which must be 1. Inverses that fail are counted: rounding
// at the rim of a triangle may cause a few.
TEST_P(ChartMoves, KnowTheWeightsOfAllTechniques) {
    int tries = 0, failed = 0;
    for_paths(20000, [&](double) {
        const std::span<const double> room = charts.weights(x);
        const std::vector<double> w(room.begin(), room.end());
        const ByDefinition d(*scene, charts.window(), x.path);
        double sum = 0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            sum += w[i];
            ASSERT_NEAR(w[i], d.weights[i], 1e-5) << "k " << x.u.k << ", t " << i + 1;
        }
        ASSERT_NEAR(sum, 1, 1e-12);
        ASSERT_NEAR(w[static_cast<std::size_t>(x.u.t) - 1], x.path.weight, 1e-12);
        for (int t = 1; t <= x.u.k + 1; ++t) {
            const double w_t = w[static_cast<std::size_t>(t) - 1];
            if (t == x.u.t || !(w_t > 0)) continue;
            ++tries;
            if (!charts.go_over(x, t, y, rng)) {
                ++failed;
                continue;
            }
            const std::span<const double> again = charts.weights(y);
            for (std::size_t i = 0; i < w.size(); ++i) ASSERT_NEAR(w[i], again[i], 1e-5);
            if (w_t < 1e-6) continue;  // relative to rounding of the path, the tail of a lobe has no digits left
            const ByDefinition e(*scene, charts.window(), y.path);
            const auto at = [](const ByDefinition& of, int technique) {
                return of.weights[static_cast<std::size_t>(technique) - 1] * of.target;
            };
            const double ratio = at(e, t) * at(e, x.u.t) / (at(d, x.u.t) * at(d, t));
            ASSERT_NEAR(ratio, 1, 1e-4) << "k " << x.u.k << ", " << x.u.t << " to " << t;
        }
    });
    EXPECT_LE(failed, 2 + 0.002 * tries);
}

// Large steps weighted by their estimates of b are distributed like the target pi(x, t). A move takes each to another
// technique of its path (or, if it moves the path as well, to one of another path), so the weight that each technique
// holds stays what it was but for noise: the sum of the changes over its own spread is normal. Seen red with the ratio
// of densities left out of the swap (|z| up to 40 on the Cornell box), with a Gibbs move that draws evenly (50), and
// with the weights left out of the inverse small step, which steps widely and often here (5.3 in keyhole-room).
class KeepsShares : public ChartMoves {
  protected:
    void expect_shares_kept(const PssStrategy& move, int paths, int moves) {
        std::map<std::pair<int, int>, std::pair<double, double>> changes;  // by k and t: sum, sum of squares
        int moved = 0;
        for_paths(paths, [&](double weight) {
            const int k = x.u.k, before = x.u.t;
            for (int j = 0; j < moves; ++j) {
                const Proposal p = move.propose(x, y, rng);
                if (p.failure == Failure::none && rng.uniform() < p.ratio) std::swap(x, y);
            }
            charts.find_technique(x, rng);
            if (x.u.t == before) return;
            ++moved;
            for (const auto& [t, change] : {std::pair(before, -weight), std::pair(x.u.t, weight)}) {
                auto& [sum, squares] = changes[{k, t}];
                sum += change;
                squares += change * change;
            }
        });
        EXPECT_GT(moved, 500);
        constexpr int techniques_in_all = 18, tests = 9;
        const double bound = normal_two_sided_quantile(sidak_level(1e-3, tests * techniques_in_all));
        for (const auto& [technique, change] : changes)
            EXPECT_LT(std::abs(change.first) / std::sqrt(change.second), bound)
                << "k " << technique.first << ", t " << technique.second;
    }
};

TEST_P(KeepsShares, OfTechniquesBySwaps) { expect_shares_kept(ChartSwap(charts, techniques), 40000, 3); }
TEST_P(KeepsShares, OfTechniquesByGibbsMoves) { expect_shares_kept(ChartGibbs(charts, techniques), 40000, 3); }
TEST_P(KeepsShares, OfTechniquesByInverseSmallSteps) {
    expect_shares_kept(InverseSmallStep<GaussianKernel>(charts, techniques, GaussianKernel(0.1)), 300000, 20);
}

// Two independent paths, each with its weight, are distributed like the product of two targets. An exchange leaves both
// chains' techniques alone; what it may change is which paths each technique has. So the weight of a path by its
// chain's own technique, averaged over the chains of that technique, stays what it was but for noise. Seen red with the
// ratio left out, which the images do not show.
class Exchanges : public ChartMoves {};

TEST_P(Exchanges, KeepThePathsOfEachTechnique) {
    std::map<int, std::pair<PssState, double>> waiting;                // by k
    std::map<std::pair<int, int>, std::pair<double, double>> changes;  // by k and t: sum, sum of squares
    const ChartExchange exchange(charts);
    PssState new_a = charts.make_state(), new_b = charts.make_state();
    int moved = 0;
    for_paths(200000, [&](double weight) {
        const int k = x.u.k;
        const auto other = waiting.find(k);
        if (other == waiting.end()) {
            waiting.emplace(k, std::pair(x, weight));
            return;
        }
        PssState b = std::move(other->second.first);
        const double product = weight * other->second.second;
        waiting.erase(other);
        if (b.u.t == x.u.t) return;
        const Proposal p = exchange.propose(x, b, new_a, new_b, rng);
        if (p.failure != Failure::none || !(rng.uniform() < p.ratio)) return;
        ++moved;
        const auto own = [&](const PssState& state, int t) { return charts.weights(state)[t - 1]; };
        for (const auto& [t, change] : {std::pair(x.u.t, own(new_a, x.u.t) - own(x, x.u.t)),
                                        std::pair(b.u.t, own(new_b, b.u.t) - own(b, b.u.t))}) {
            auto& [sum, squares] = changes[{k, t}];
            sum += product * change;
            squares += product * product * change * change;
        }
    });
    EXPECT_GT(moved, 500);
    const double bound = normal_two_sided_quantile(sidak_level(1e-3, 3 * 18));
    for (const auto& [technique, change] : changes)
        EXPECT_LT(std::abs(change.first) / std::sqrt(change.second), bound)
            << "k " << technique.first << ", t " << technique.second;
}

// Paths of 64 edges through 1e5 accepted swaps and Gibbs moves: no overflow, and the path drifts by no more than
// rounding adds up to, as each re-traced path is the next one's start.
TEST(LongPaths, SurviveManyMovesBetweenCharts) {
    constexpr int length = 64, wanted = 100000;
    const auto scene = closed_room();
    const CoordinateLayout layout(*scene, length);
    ChartEvaluator evaluator(*scene, layout, {}, {.path = true, .forgets = true});
    const TechniqueDistribution techniques(length, length);
    const LargeStep large(evaluator, techniques);
    const ChartSwap swap(evaluator, techniques);
    const ChartGibbs gibbs(evaluator, techniques);
    PssState x = evaluator.make_state(), y = evaluator.make_state();
    Rng rng(4, 1);
    int tries = 0;
    do large.draw(x, rng);
    while (!(x.target > 0) && ++tries < 1000000);
    ASSERT_GT(x.target, 0);
    const Path first = join(x.path.eye(), x.path.light());
    const double target = x.target;
    int accepted = 0, refused = 0;
    while (accepted < wanted && refused < 20 * wanted) {
        const PssStrategy& move = rng.below(2) == 0 ? static_cast<const PssStrategy&>(swap) : gibbs;
        const Proposal p = move.propose(x, y, rng);
        ASSERT_TRUE(p.failure != Failure::none || std::isfinite(p.ratio));
        if (p.failure != Failure::none || !(rng.uniform() < p.ratio)) {
            ++refused;
            continue;
        }
        std::swap(x, y);
        ++accepted;
    }
    EXPECT_EQ(accepted, wanted) << refused << " were refused";
    const double drift = deviation(x.path, first.x);
    std::cout << "after " << accepted << " moves, of " << accepted + refused << " tries, the path is off by " << drift
              << "\n";
    EXPECT_LT(drift, 1e-2);
    EXPECT_NEAR(x.target / target, 1, 0.1);
}

std::vector<TransportCase> cases() {
    std::vector<TransportCase> all = transport_cases();
    std::erase_if(all, [](const TransportCase& c) { return c.scene == "four-holes"; });  // paths of one edge only
    return all;
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, ChartMoves, testing::ValuesIn(cases()), test_name_of_case);
const auto few_scenes = testing::Values(TransportCase{"cornell-box"}, TransportCase{"glossy-room"},
                                        TransportCase{"keyhole-room", {{"hole", "0.4"}}});
INSTANTIATE_TEST_SUITE_P(OwnScenes, KeepsShares, few_scenes, test_name_of_case);
INSTANTIATE_TEST_SUITE_P(OwnScenes, Exchanges, few_scenes, test_name_of_case);

}  // namespace
}  // namespace keyhole
