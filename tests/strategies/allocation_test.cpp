// The inner loop allocates nothing: steps of a warm chain are counted by the global operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "chain/metropolis.h"
#include "own_scenes.h"
#include "strategies/mmlt.h"

namespace {
std::atomic<std::uint64_t> allocations{0};
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // g++ does not see that both operators are replaced
#endif
void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace keyhole {
namespace {

struct NoFilm {
    void splat(const PssState&, double) {}
};

class Loop : public testing::TestWithParam<const char*> {};

TEST_P(Loop, AllocatesNothing) {
    const auto scene = own_scene(GetParam());
    const CoordinateLayout layout(*scene, 8);
    Chart chart(*scene, layout);
    const TechniqueDistribution techniques(1, 8);
    std::vector<Mixture<PssState, Rng>::Component> components;
    components.push_back({std::make_unique<LargeStep>(chart, techniques), 0.3});
    components.push_back({std::make_unique<SmallStep<KelemenKernel>>(chart, KelemenKernel()), 0.6});
    components.push_back({std::make_unique<TechniqueChange>(chart, techniques), 0.1});
    const Mixture<PssState, Rng> mixture(std::move(components));
    const LargeStep large(chart, techniques);
    Rng rng(1);
    PssState start(layout);
    for (int i = 0; i < 100000 && !(start.target > 0); ++i) large.draw(start, rng);
    ASSERT_GT(start.target, 0);
    Chain<PssState> chain(start);
    Diagnostics diagnostics(mixture.size());
    NoFilm film;
    for (int i = 0; i < 1000; ++i) chain.step(mixture, rng, film, diagnostics);
    const std::uint64_t before = allocations;
    for (int i = 0; i < 20000; ++i) chain.step(mixture, rng, film, diagnostics);
    EXPECT_EQ(allocations, before);
    // The counter counts: what follows allocates.
    const PssState copy = start;
    EXPECT_GT(allocations, before);
    EXPECT_GT(copy.target, 0);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Loop, testing::Values("cornell-box", "glossy-room", "gallery", "veil", "stage"));

// What a chain holds: two states of maximal length 12.
TEST(Chain, OfLengthTwelveCostsLessThanEightKilobytes) {
    const auto scene = own_scene("gallery");
    const CoordinateLayout layout(*scene, 12);
    const PssState state(layout);
    const std::size_t coordinates = (state.u.eye.capacity() + state.u.light.capacity()) * sizeof(double);
    EXPECT_LT(2 * (sizeof(PssState) + coordinates) + sizeof(Chain<PssState>) + sizeof(Rng), 8192u);
}

}  // namespace
}  // namespace keyhole
