// A chain in primary sample space is saved and goes on bit for bit.
#include <gtest/gtest.h>

#include "mmlt_chain.h"

namespace keyhole {
namespace {

struct Splat {
    double x, y, r, g, b, weight;
    bool operator==(const Splat&) const = default;
};

struct Record {
    std::vector<Splat> splats;
    void splat(const PssState& s, double weight) {
        splats.push_back({s.raster.x(), s.raster.y(), s.splat[0], s.splat[1], s.splat[2], weight});
    }
};

// All that there is to save: the technique and the coordinates that it reads, the held weight, and the position of the
// random numbers.
struct Saved {
    int k, t;
    std::vector<double> coordinates;
    double held;
    Rng::State random;
};

Saved save(const Chain<PssState>& chain, const Rng& rng, const CoordinateLayout& layout) {
    const PrimarySample& u = chain.current().u;
    return {u.k, u.t, {u.data(), u.data() + layout.count(u.k, u.t)}, chain.held(), rng.state()};
}

// Coordinates that were not saved are filled with numbers that any use of them would show.
Chain<PssState> restore(const Saved& saved, Evaluator& evaluator) {
    PssState state(evaluator.layout());
    state.u.k = saved.k;
    state.u.t = saved.t;
    std::fill(state.u.coordinates.begin(), state.u.coordinates.end(), -1e30);
    std::copy(saved.coordinates.begin(), saved.coordinates.end(), state.u.data());
    evaluator.evaluate(state);
    return Chain<PssState>(state, saved.held);
}

class SavedChain : public testing::TestWithParam<std::string> {};

TEST_P(SavedChain, ContinuesBitForBit) {
    const auto scene = own_scene(GetParam());
    MmltChain mmlt(*scene, 6);
    Rng rng(3);
    Chain<PssState> chain(mmlt.first_state(rng));
    ASSERT_GT(chain.current().target, 0);
    Diagnostics diagnostics(mmlt.mixture.size());
    Record before, after, restored_after;
    // Saved again and again: at any position in the buffer of random numbers, and in different techniques.
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 137; ++i) chain.step(mmlt.mixture, rng, before, diagnostics);

        const Saved saved = save(chain, rng, mmlt.layout);
        Chain<PssState> restored = restore(saved, mmlt.evaluator);
        Rng restored_rng(saved.random);
        Diagnostics restored_diagnostics = diagnostics;
        ASSERT_EQ(restored.current().target, chain.current().target);
        for (int i = 0; i < 137; ++i) restored.step(mmlt.mixture, restored_rng, restored_after, restored_diagnostics);
        for (int i = 0; i < 137; ++i) chain.step(mmlt.mixture, rng, after, diagnostics);

        ASSERT_EQ(after.splats, restored_after.splats);
        ASSERT_EQ(chain.held(), restored.held());
        ASSERT_EQ(rng.state(), restored_rng.state());
        ASSERT_EQ(diagnostics, restored_diagnostics);
    }
    EXPECT_GT(after.splats.size(), 100u);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, SavedChain, testing::ValuesIn(own_scene_names()),
                         [](const auto& test) { return test_name_of(test.param); });

}  // namespace
}  // namespace keyhole
