// Moves in path space leave their target alone, whatever their parameters, on the project's own scenes.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <fstream>

#include "chain/mixture.h"
#include "own_scenes.h"
#include "pathspace/neighbours.h"
#include "statistics.h"
#include "strategies/bidirectional.h"
#include "strategies/caustic.h"
#include "strategies/cone_step_size.h"
#include "strategies/mix_file.h"
#include "strategies/portal.h"

namespace keyhole {
namespace {

constexpr int max_length = 4;

// Steps of any size, by a hash of the edge: as wrong as an estimate of a cone can be.
class NoiseStepSize final : public StepSize {
  public:
    DirectionKernel operator()(const Vertex& from, const Vertex& to) const override {
        std::uint64_t hash = 0;
        for (const double c : {from.x.p.x(), from.x.p.y(), to.x.p.x(), to.x.p.y(), to.x.p.z()})
            hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL, hash ^= hash >> 29;
        const double r_max = 0.02 + 0.5 * static_cast<double>(hash >> 11) * 0x1p-53;
        return {0.3 * r_max, r_max};
    }
};

struct MoveCase {
    std::string name;
    std::unique_ptr<PssStrategy> (*make)(ChartEvaluator&);
};

void PrintTo(const MoveCase& c, std::ostream* out) { *out << c.name; }

constexpr double wide = 0.3;  // counts as specular: many chains
std::unique_ptr<const StepSize> fixed_size() { return std::make_unique<FixedStepSize>(0.05, 0.5); }
std::unique_ptr<const StepSize> cones(ChartEvaluator& charts, ConeEstimator estimator) {
    ConeSettings settings;
    settings.estimator = estimator;
    return std::make_unique<ConeStepSize>(charts.tracer().scene(), settings, 0.1);
}
template <EyePerturbation::Chains chains>
std::unique_ptr<PssStrategy> eye(ChartEvaluator& charts, std::unique_ptr<const StepSize> size, bool raster = false) {
    return std::make_unique<EyePerturbation>(charts, chains, std::move(size), wide, RasterStep{raster, 0.5, 6});
}
constexpr auto one = EyePerturbation::Chains::one, many = EyePerturbation::Chains::many;
std::unique_ptr<PssStrategy> portal(ChartEvaluator& charts, PortalCrossings::Edges edges, PortalPoint point) {
    return std::make_unique<PortalPerturbation>(charts, edges, point, DirectionKernel{0.05, 0.8});
}
using Edges = PortalCrossings::Edges;
using Move = PortalPoint::Move;

const std::vector<MoveCase>& moves() {
    static const std::vector<MoveCase> list = {
        {"bidirectional",
         [](ChartEvaluator& c) -> std::unique_ptr<PssStrategy> {
             return std::make_unique<Bidirectional>(c, PathLengths{1, max_length});
         }},
        {"lens_raster", [](ChartEvaluator& c) { return eye<one>(c, fixed_size(), true); }},
        {"lens_angle", [](ChartEvaluator& c) { return eye<one>(c, fixed_size()); }},
        {"lens_noise", [](ChartEvaluator& c) { return eye<one>(c, std::make_unique<NoiseStepSize>()); }},
        {"lens_fast", [](ChartEvaluator& c) { return eye<one>(c, cones(c, ConeEstimator::fast)); }},
        {"lens_cut", [](ChartEvaluator& c) { return eye<one>(c, cones(c, ConeEstimator::bvh_cut)); }},
        {"multichain", [](ChartEvaluator& c) { return eye<many>(c, fixed_size()); }},
        {"multichain_noise", [](ChartEvaluator& c) { return eye<many>(c, std::make_unique<NoiseStepSize>()); }},
        {"caustic_raster",
         [](ChartEvaluator& c) -> std::unique_ptr<PssStrategy> {
             return std::make_unique<CausticPerturbation>(c, fixed_size(), RasterStep{true, 0.5, 6}, wide);
         }},
        {"caustic_noise",
         [](ChartEvaluator& c) -> std::unique_ptr<PssStrategy> {
             return std::make_unique<CausticPerturbation>(c, std::make_unique<NoiseStepSize>(), RasterStep{}, wide);
         }},
        {"portal_fixed",
         [](ChartEvaluator& c) {
             return portal(c, Edges::nearest, {Move::fixed, 0});
         }},
        {"portal_any",
         [](ChartEvaluator& c) {
             return portal(c, Edges::any, {Move::fixed, 0});
         }},
        {"portal_gaussian",
         [](ChartEvaluator& c) {
             return portal(c, Edges::nearest, {Move::gaussian, 0.3});
         }},
        {"portal_uniform",
         [](ChartEvaluator& c) {
             return portal(c, Edges::any, {Move::uniform, 0});
         }},
        {"portal_lens",
         [](ChartEvaluator& c) -> std::unique_ptr<PssStrategy> {
             return std::make_unique<PortalLens>(c, fixed_size(), wide, RasterStep{true, 0.5, 6},
                                                 PortalPoint{Move::gaussian, 0.3});
         }},
    };
    return list;
}

std::vector<TransportCase> scenes() {
    return {{"three-planes", {{"hole", "0.3"}}},   {"keyhole-room", {{"hole", "0.4"}}},
            {"box-in-the-sun", {{"hole", "0.5"}}}, {"glossy-room"},
            {"glass-caustic", {{"light", "0.5"}}}, {"gallery"}};
}

// With two more portals, so that edges pass one to three of them.
std::unique_ptr<Scene> scene_with_portals(const TransportCase& c) {
    ReaderOptions options;
    options.width = options.height = 16;
    options.defines = c.defines;
    options.portals = testing::TempDir() + "keyhole-more-portals.xml";
    std::ofstream(options.portals) << R"(<scene version="3.0.0">
        <shape type="portal"><transform name="to_world">
            <rotate x="1" angle="90"/><translate x="0.9" y="1.4"/></transform></shape>
        <shape type="portal"><transform name="to_world">
            <scale value="0.7"/><rotate x="1" angle="70"/><translate z="-0.6" y="1.2"/></transform></shape></scene>)";
    return read_scene((own_scenes_folder / (c.scene + ".xml")).string(), options).scene;
}

const std::vector<std::string> fused_mixes = {"fused-all", "fused-all-walk-on"};

// Paths drawn in proportion to the target, and whether moves leave them so.
class Stationarity : public testing::Test {
  protected:
    explicit Stationarity(const TransportCase& c)
        : scene(c.scene == "three-planes" ? scene_with_portals(c) : own_scene(c, 16, 16)) {}

    std::unique_ptr<Scene> scene;
    CoordinateLayout layout{*scene, max_length};
    ChartEvaluator charts{*scene, layout, {}, {.path = true, .forgets = true, .measure = true}};
    TechniqueDistribution techniques{1, max_length};
    LargeStep large{charts, techniques};
    PssState x = charts.make_state(), y = charts.make_state();
    Rng rng{7, 1};

    // Features of a path that moves change: where it is seen, the angles and lengths of its edges, what it carries, and
    // what the steps of noise are at both of its ends.
    static constexpr std::size_t features = 15;
    std::array<double, features> features_of(const PssState& state) {
        std::array<double, features> f{};
        const Vec2 u = charts.window().to_unit(state.raster);
        const auto v = [&](int i) -> const Vertex& { return state.path.room[static_cast<std::size_t>(i)]; };
        const int k = state.path.k;
        f[0] = u.x();
        f[1] = u.y();
        f[2] = k;
        f[3] = state.target / (state.target + typical_target);
        for (int i = 0; i < std::min(k, 4); ++i) {
            const Vec3 d = v(i).infinite ? Vec3(-v(i).x.p) : direction(v(i), v(i + 1));
            f[4 + static_cast<std::size_t>(i)] = std::abs(d.y());
            const bool finite = !v(i).infinite && !v(i + 1).infinite;
            f[8 + static_cast<std::size_t>(i)] =
                finite ? std::exp(-2 * (v(i + 1).x.p - v(i).x.p).norm() / scene->radius()) : 0;
        }
        const NoiseStepSize noise;
        f[12] = noise(v(0), v(1)).r_max;
        f[13] = k > 1 ? noise(v(k), v(k - 1)).r_max : 0;
        f[14] = k > 2 ? noise(v(k - 1), v(k - 2)).r_max : 0;
        return f;
    }

    // Large steps weighted by their estimates of b are distributed like the target, and so they are after some moves:
    // the weighted mean of each feature stays what it was but for noise, which the changes themselves tell.
    // move_on(suited) makes 12 moves of x, counts those that apply and tells whether x has changed.
    template <class MoveOn>
    void expect_target_kept(int draws, const MoveOn& move_on) {
        std::array<double, features> sums{}, squares{};
        int moved = 0, suited = 0;
        double mean = 0;
        for (int i = 0; i < draws; ++i) {
            large.draw(x, rng);
            if (!(x.target > 0)) continue;
            const double weight = large.estimate(x);
            mean += (weight - mean) / (i + 1);
            if (typical_target == 0) typical_target = x.target;
            if (!(weight > 1e-7 * mean)) continue;
            const auto before = features_of(x);
            if (!move_on(suited)) continue;
            ++moved;
            const auto after = features_of(x);
            for (std::size_t f = 0; f < features; ++f) {
                const double change = weight * (after[f] - before[f]);
                sums[f] += change;
                squares[f] += change * change;
            }
        }
        if (suited < 1000) GTEST_SKIP() << "does not apply here";
        EXPECT_GT(moved, suited > 3000 ? 20 : -1) << "of " << suited;
        const std::size_t tests = features * (moves().size() + fused_mixes.size()) * scenes().size();
        const double bound = normal_two_sided_quantile(sidak_level(1e-3, static_cast<int>(tests)));
        for (std::size_t f = 0; f < features; ++f)
            EXPECT_LE(std::abs(sums[f]), bound * std::sqrt(squares[f])) << "feature " << f;
    }
    static constexpr int moves_each = 12;

    bool accept(double ratio) {
        EXPECT_TRUE(std::isfinite(ratio));
        if (!(rng.uniform() < ratio)) return false;
        std::swap(x, y);
        return true;
    }

    double typical_target = 0;
};

class PathMoves : public Stationarity, public testing::WithParamInterface<std::tuple<TransportCase, MoveCase>> {
  protected:
    PathMoves() : Stationarity(std::get<0>(GetParam())), move(std::get<1>(GetParam()).make(charts)) {}

    std::unique_ptr<PssStrategy> move;
};

// Selection probabilities are those of a mixture of this strategy alone: 1 where it applies. Seen red, one at a time:
// with the portal's cosine left out, with the number of crossings left out, with the size of x's step in place of y's,
// without the check of the support, and with one way to build the path in the bidirectional mutation.
TEST_P(PathMoves, KeepTheTarget) {
    const int draws = std::get<1>(GetParam()).name.starts_with("portal") ? 600000 : 60000;
    expect_target_kept(draws, [&](int& suited) {
        bool changed = false;
        for (int j = 0; j < moves_each && move->suitability(x) > 0; ++j) {
            ++suited;
            const Proposal p = move->propose(x, y, rng);
            EXPECT_NE(p.failure, Failure::non_finite);
            if (p.failure == Failure::none) changed |= accept(p.ratio * move->suitability(y));
        }
        return changed;
    });
}

class FusedMoves : public Stationarity, public testing::WithParamInterface<std::tuple<TransportCase, std::string>> {
  protected:
    FusedMoves() : Stationarity(std::get<0>(GetParam())) {}

    Mixture<PssState, Rng> make_mixture(const Mix& mix) {
        const StrategyContext context{charts, &charts, techniques, {1, max_length}, mix.rectification};
        std::vector<Mixture<PssState, Rng>::Component> components;
        for (const MixStrategy& s : mix.strategies)
            if (s.info->hindrance(*scene, {1, max_length}).empty())
                components.push_back({s.info->make(context, s.parameters), s.weight});
        return Mixture<PssState, Rng>(std::move(components));
    }
};

// Moves of both spaces in one chain: the technique drawn from its conditional and coordinates from the inverse where a
// move asks for them, states as the moves before have left them. Seen red with the technique drawn evenly among those
// that can make the path.
TEST_P(FusedMoves, KeepTheTarget) {
    const Mixture<PssState, Rng> mixture = make_mixture(builtin_mix(std::get<1>(GetParam())));
    expect_target_kept(1000000, [&](int& suited) {
        bool changed = false;
        for (int j = 0; j < moves_each; ++j) {
            ++suited;
            const auto selection = mixture.select(x, rng);
            const Proposal p = mixture.strategy(selection.index).propose(x, y, rng);
            if (p.failure == Failure::none) changed |= accept(mixture.completed_ratio(p.ratio, selection, y));
        }
        return changed;
    });
}

// What a move leaves is a state like any other: its C, its weights and its contribution are those of its path.
TEST_P(PathMoves, LeaveCompleteStates) {
    int checked = 0;
    for (int i = 0; i < 20000 && checked < 300; ++i) {
        large.draw(x, rng);
        if (!(x.target > 0) || !(move->suitability(x) > 0)) continue;
        if (move->propose(x, y, rng).failure != Failure::none) continue;
        ++checked;
        ASSERT_EQ(y.known, Known::path);
        ASSERT_TRUE(y.target > 0 && std::isfinite(y.target));
        ASSERT_NEAR(luminance(y.splat), 1, 1e-9);
        const std::span<const double> w = charts.weights(y);
        double sum = 0;
        for (const double weight : w) sum += weight;
        ASSERT_NEAR(sum, 1, 1e-9);
        if (!charts.find_coordinates(y, rng)) continue;
        const double target = y.target;
        const Vec2 raster = y.raster;
        ASSERT_EQ(charts.evaluate(y), PathFailure::none);
        ASSERT_NEAR(y.target / target, 1, 1e-2);
        ASSERT_LE((y.raster - raster).norm(), 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, PathMoves,
                         testing::Combine(testing::ValuesIn(scenes()), testing::ValuesIn(moves())),
                         [](const auto& test) {
                             return test_name_of(std::get<0>(test.param).scene) + "_" + std::get<1>(test.param).name;
                         });

INSTANTIATE_TEST_SUITE_P(OwnScenes, FusedMoves,
                         testing::Combine(testing::ValuesIn(scenes()), testing::ValuesIn(fused_mixes)),
                         [](const auto& test) {
                             return test_name_of(std::get<0>(test.param).scene + "_" + std::get<1>(test.param));
                         });

}  // namespace
}  // namespace keyhole
