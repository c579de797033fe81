// What a chain allocates: nothing in the inner loop, and little in all. The global operator new counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "chain/mixing.h"
#include "chain/running_mean.h"
#include "mmlt_chain.h"
#include "strategies/mix_states.h"
#include "strategies/registry.h"
#include "strategies/with_unused.h"

namespace {
std::atomic<std::uint64_t> allocations{0}, allocated_bytes{0};

void* allocate(std::size_t size) {
    ++allocations;
    allocated_bytes += size;
    return std::malloc(size);
}
}  // namespace

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // g++ does not see that both operators are replaced
#endif
void* operator new(std::size_t size) {
    if (void* p = allocate(size)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace keyhole {
namespace {

struct NoFilm {
    void splat(const PssState&, double) {}
};

class Loop : public testing::TestWithParam<std::string> {};

TEST_P(Loop, AllocatesNothing) {
    const auto scene = own_scene(GetParam());
    MmltChain mmlt(*scene, 8);
    Rng rng(1);
    const PssState start = mmlt.first_state(rng);
    ASSERT_GT(start.target, 0);
    Chain<PssState> chain(start);
    Diagnostics diagnostics(mmlt.mixture.size());
    NoFilm film;
    for (int i = 0; i < 1000; ++i) chain.step(mmlt.mixture, rng, film, diagnostics);
    const std::uint64_t before = allocations;
    for (int i = 0; i < 20000; ++i) chain.step(mmlt.mixture, rng, film, diagnostics);
    EXPECT_EQ(allocations, before);
    // The counter counts: what follows allocates.
    const PssState copy = start;
    EXPECT_GT(allocations, before);
    EXPECT_GT(copy.target, 0);
}

class PathLoop : public testing::TestWithParam<std::string> {};

// Moves in path space, cones and portals included, and moves in primary sample space from the paths that they leave.
TEST_P(PathLoop, AllocatesNothing) {
    const auto scene = own_scene(GetParam());
    const CoordinateLayout layout(*scene, 8);
    ChartEvaluator charts(*scene, layout, {}, {.path = true, .forgets = true, .measure = true});
    const TechniqueDistribution techniques(1, 8);
    const StrategyContext context{charts, &charts, techniques, {1, 8}, {}};
    std::vector<Mixture<PssState, Rng>::Component> components;
    for (const StrategyInfo& info : strategy_registry()) {
        Values values;
        for (const Parameter& p : info.parameters) values[p.name] = p.fallback;
        if (info.hindrance(*scene, {1, 8}).empty()) components.push_back({info.make(context, values), 1});
    }
    const Mixture<PssState, Rng> mixture(std::move(components));
    PssState start = charts.make_state();
    Rng rng(1);
    const LargeStep large(charts, techniques);
    for (int i = 0; i < 1000000 && !(start.target > 0); ++i) large.draw(start, rng);
    ASSERT_GT(start.target, 0);
    Chain<PssState> chain(start);
    Diagnostics diagnostics(mixture.size());
    NoFilm film;
    for (int i = 0; i < 3000; ++i) chain.step(mixture, rng, film, diagnostics);
    const std::uint64_t before = allocations;
    for (int i = 0; i < 20000; ++i) chain.step(mixture, rng, film, diagnostics);
    EXPECT_EQ(allocations, before);
}

// What makes the states of the mix and one of them, by what they allocate.
struct Allocated {
    std::uint64_t allocations, bytes;
    bool operator==(const Allocated&) const = default;
};
Allocated allocated_by(const Mix& mix, const Scene& scene) {
    const CoordinateLayout layout(scene, mix.lengths.max);
    const Allocated before{allocations, allocated_bytes};
    const auto evaluator = make_evaluator(scene, layout, mix);
    const PssState state = evaluator->make_state();
    return {allocations - before.allocations, allocated_bytes - before.bytes};
}

// What a mix does not use costs no memory: strategies of weight zero leave nothing behind. Their time is measured
// (docs/benchmarks.md).
TEST(UnusedStrategies, CostNothing) {
    const auto scene = own_scene("keyhole-room");
    Mix mmlt = builtin_mix("mmlt");
    mmlt.lengths.max = 8;
    Mix all = with_unused(mmlt);
    EXPECT_EQ(allocated_by(all, *scene), allocated_by(mmlt, *scene));
    all.strategies.back().weight = 1;
    EXPECT_GT(allocated_by(all, *scene).bytes, allocated_by(mmlt, *scene).bytes);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, PathLoop, testing::ValuesIn(own_scene_names()),
                         [](const auto& test) { return test_name_of(test.param); });

INSTANTIATE_TEST_SUITE_P(OwnScenes, Loop, testing::ValuesIn(own_scene_names()),
                         [](const auto& test) { return test_name_of(test.param); });

class ChainOfLengthTwelve : public testing::TestWithParam<std::string> {};

// Everything that is kept of one chain: its states and the held weight, its random numbers, its estimate of b, what is
// followed of its states, and three counters.
TEST_P(ChainOfLengthTwelve, CostsLessThanEightKilobytes) {
    const auto scene = own_scene(GetParam());
    const CoordinateLayout layout(*scene, 12);
    const PssState start(layout);
    const std::uint64_t before = allocated_bytes;
    const Chain<PssState> chain(start);
    const std::uint64_t states = allocated_bytes - before;
    EXPECT_GE(states, 2 * sizeof(double) * layout.capacity());
    constexpr std::size_t followed = sizeof(RunningMean) + sizeof(StateMoments<3>) + 3 * sizeof(std::uint64_t);
    EXPECT_LT(states + sizeof(chain) + sizeof(Rng) + followed, 8192u);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, ChainOfLengthTwelve, testing::ValuesIn(own_scene_names()),
                         [](const auto& test) { return test_name_of(test.param); });

}  // namespace
}  // namespace keyhole
