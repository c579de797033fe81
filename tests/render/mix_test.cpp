// What a mix says is what its chains do, and none of it changes the image they converge to.
#include <gmock/gmock.h>

#include "own_scenes.h"
#include "render/replicates.h"

namespace keyhole {
namespace {

// False-alarm level of all comparisons of images in this file.
constexpr double family_level = 1e-3;

struct Variant {
    const char* name;
    std::vector<Setting> settings;
};

const Variant variants[] = {
    {"fixed-lengths", {{"lengths.per-chain", "fixed", ""}}},
    {"max-channel", {{"target", "max-channel", ""}}},
    {"both-gaussian",
     {{"lengths.per-chain", "fixed", ""}, {"target", "max-channel", ""}, {"small-step.kernel", "gaussian", ""}}},
};
const char* const scenes[] = {"cornell-box", "gallery"};

class MixVariants : public testing::TestWithParam<const char*> {};

// Sixteen chains for five lengths: their numbers are far from in proportion to b by length, which has to make up for
// it.
TEST_P(MixVariants, AgreeWithBidirectionalPathTracing) {
    const auto scene = own_scene(GetParam(), 12, 12);
    constexpr int runs = 12;
    RenderSettings settings;
    settings.mix.lengths.max = 5;
    settings.integrator = Integrator::bdpt;
    settings.mutations_per_pixel = 400;
    const Replicates bdpt = render_replicates(*scene, settings, runs);
    settings.integrator = Integrator::mmlt;
    settings.mutations_per_pixel = 2000;
    settings.mix.chain_count = 5;
    settings.mix.bootstrap_samples = 20000;
    for (const Variant& variant : variants) {
        RenderSettings changed = settings;
        apply_settings(changed.mix, variant.settings);
        expect_agreement(render_replicates(*scene, changed, runs), bdpt,
                         sidak_level(family_level, static_cast<int>(std::size(variants) * std::size(scenes))),
                         std::string(GetParam()) + "-" + variant.name);
    }
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, MixVariants, testing::ValuesIn(scenes), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

RenderSettings small_run() {
    RenderSettings settings;
    settings.mutations_per_pixel = 100;
    settings.mix.lengths = {2, 5, true};
    settings.mix.chain_count = 40;
    settings.mix.bootstrap_samples = 4000;
    return settings;
}

TEST(FixedLengths, AreReportedOneByOne) {
    const auto scene = own_scene("cornell-box", 8, 8);
    const RenderSettings settings = small_run();
    const RenderStatistics statistics = render(*scene, settings).statistics;
    ASSERT_EQ(statistics.lengths.size(), 4u);
    std::uint64_t chains = 0;
    double b = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const LengthStatistics& s = statistics.lengths[i];
        EXPECT_EQ(s.length, static_cast<int>(i) + 2);
        EXPECT_GE(s.chains, 1u);
        EXPECT_GT(s.b_standard_error, 0);
        chains += s.chains;
        b += s.b;
    }
    EXPECT_EQ(chains, 40u);
    EXPECT_DOUBLE_EQ(b, statistics.b);
    EXPECT_GT(statistics.lengths.front().chains, statistics.lengths.back().chains);  // there is more direct light
}

TEST(FixedLengths, NeedAChainEach) {
    const auto scene = own_scene("cornell-box", 8, 8);
    RenderSettings settings = small_run();
    settings.mix.chain_count = 3;
    EXPECT_THROW(render(*scene, settings), std::invalid_argument);
    settings.mix.chain_count = 4;
    for (const LengthStatistics& s : render(*scene, settings).statistics.lengths) EXPECT_EQ(s.chains, 1u);
}

TEST(FixedLengths, GiveTheSameBitsWithAnyNumberOfThreads) {
    const auto scene = own_scene("cornell-box", 8, 8);
    RenderSettings settings = small_run();
    settings.threads = 1;
    const Image one = render(*scene, settings).image;
    settings.threads = 3;
    EXPECT_EQ(render(*scene, settings).image.rgb, one.rgb);
}

TEST(Mixes, StrategiesAreChosenByWeightAndCountedByLabel) {
    const auto scene = own_scene("cornell-box", 8, 8);
    RenderSettings settings = small_run();
    settings.mix = parse_mix(R"(
[lengths]
max = 4
[[strategy]]
type = "small-step"
weight = 2
[[strategy]]
type = "technique-change"
weight = 0
[[strategy]]
type = "small-step"
weight = 5
kernel = "gaussian"
[[strategy]]
type = "large-step"
label = "afresh"
weight = 3
)",
                             "mix.toml");
    settings.mix.bootstrap_samples = 4000;
    const RenderStatistics statistics = render(*scene, settings).statistics;
    ASSERT_EQ(statistics.strategies.size(), 3u);  // without the one of weight zero
    const char* const labels[] = {"small-step", "small-step-2", "afresh"};
    const double shares[] = {0.2, 0.5, 0.3};
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(statistics.strategies[i].name, labels[i]);
        const double share = static_cast<double>(statistics.strategies[i].proposals) / statistics.mutations;
        // Seven standard deviations: false alarms below 1e-11.
        EXPECT_NEAR(share, shares[i], 7 * std::sqrt(0.25 / static_cast<double>(statistics.mutations)));
    }
}

TEST(Mixes, ThatCannotMoveHereAreWarnedAbout) {
    const auto scene = own_scene("cornell-box", 8, 8);
    RenderSettings settings = small_run();
    EXPECT_THAT(render(*scene, settings).statistics.warnings, testing::IsEmpty());
    settings.mix.lengths = {1, 1, false};
    settings.mix.bootstrap_samples = 40000;  // few pixels see the lamp
    EXPECT_THAT(
        render(*scene, settings).statistics.warnings,
        testing::ElementsAre("strategy 'technique-change' never applies here: paths of one edge have one technique "
                             "only"));
}

}  // namespace
}  // namespace keyhole
