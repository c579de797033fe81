// The errors that a render of chains reports, held against the spread of many independent renders.
#include <gmock/gmock.h>

#include "chain/running_mean.h"
#include "own_scenes.h"
#include "render/render.h"

namespace keyhole {
namespace {

// Reported variances against measured ones, summed over the values of an image.
struct VarianceCheck {
    std::vector<RunningMean> values;
    double reported = 0;
    int runs = 0;

    template <class Values, class Errors>
    void add(const Values& v, const Errors& errors) {
        values.resize(v.size());
        for (std::size_t i = 0; i < v.size(); ++i) {
            values[i].add(v[i]);
            reported += static_cast<double>(errors[i]) * errors[i];
        }
        ++runs;
    }
    double ratio() const {
        double measured = 0;
        for (const RunningMean& value : values) measured += value.variance();
        return reported / runs / measured;
    }
};

struct ErrorsCase {
    const char* name;
    const char* scene;
    std::vector<Setting> settings;
    double mutations_per_pixel;
};

void PrintTo(const ErrorsCase& c, std::ostream* out) { *out << c.name; }

class Errors : public testing::TestWithParam<ErrorsCase> {};

// Over 120 runs a variance is known to sqrt(2 / 119) = 13% for one value, and to less for the sum over an image, whose
// largest terms count; the reported one is a mean over runs. Errors by replicates take a nonlinear estimate for linear,
// and their chains' shares for given, which is good to some percent for runs as short as these.
TEST_P(Errors, AreThoseOfIndependentRuns) {
    const auto scene = own_scene(GetParam().scene, 12, 12);
    RenderSettings settings;
    settings.mutations_per_pixel = GetParam().mutations_per_pixel;
    settings.mix.chain_count = 64;
    settings.mix.bootstrap_samples = 8192;
    settings.mix.lengths.max = 5;
    settings.error_image = true;
    apply_settings(settings.mix, GetParam().settings);
    VarianceCheck pixels, blocks, mean, b;
    for (int run = 0; run < 120; ++run) {
        settings.mix.seed = 100 + static_cast<std::uint64_t>(run);
        const RenderResult result = render(*scene, settings);
        const RenderStatistics& s = result.statistics;
        ASSERT_EQ(s.errors.replicates, 16);
        pixels.add(result.image.rgb, result.error.rgb);
        blocks.add(s.errors.block_means, s.errors.block_errors);
        double sum = 0;
        for (const double block : s.errors.block_means) sum += block / static_cast<double>(s.errors.block_means.size());
        mean.add(std::vector{sum}, std::vector{s.errors.image_mean});
        b.add(std::vector{s.b}, std::vector{s.b_standard_error});
    }
    EXPECT_THAT(pixels.ratio(), testing::AllOf(testing::Gt(0.75), testing::Lt(1.35)));
    EXPECT_THAT(blocks.ratio(), testing::AllOf(testing::Gt(0.75), testing::Lt(1.35)));
    // One value each: four standard errors of its variance.
    EXPECT_THAT(mean.ratio(), testing::AllOf(testing::Gt(0.6), testing::Lt(2.0)));
    EXPECT_THAT(b.ratio(), testing::AllOf(testing::Gt(0.6), testing::Lt(2.0)));
}

INSTANTIATE_TEST_SUITE_P(
    Renders, Errors,
    testing::Values(ErrorsCase{"short_run", "cornell-box", {}, 20}, ErrorsCase{"longer", "cornell-box", {}, 400},
                    ErrorsCase{"gallery", "gallery", {}, 100},
                    ErrorsCase{"other_target", "cornell-box", {{"target", "max-channel", ""}}, 100},
                    ErrorsCase{"fixed_lengths", "cornell-box", {{"lengths.per-chain", "fixed", ""}}, 100}),
    [](const auto& test) { return std::string(test.param.name); });

RenderSettings small_run() {
    RenderSettings settings;
    settings.mutations_per_pixel = 100;
    settings.mix.chain_count = 64;
    settings.mix.bootstrap_samples = 8192;
    settings.mix.lengths.max = 5;
    return settings;
}

TEST(ErrorImage, ChangesNothingElse) {
    const auto scene = own_scene("cornell-box", 12, 12);
    RenderSettings settings = small_run();
    const RenderResult without = render(*scene, settings);
    settings.error_image = true;
    settings.threads = 3;
    const RenderResult with = render(*scene, settings);
    EXPECT_EQ(with.image.rgb, without.image.rgb);
    EXPECT_EQ(with.statistics.errors.block_errors, without.statistics.errors.block_errors);
    EXPECT_TRUE(without.error.rgb.empty());
    EXPECT_EQ(with.error.rgb.size(), with.image.rgb.size());
    settings.threads = 1;
    EXPECT_EQ(render(*scene, settings).error.rgb, with.error.rgb);
}

TEST(ErrorStatistics, AddUp) {
    const auto scene = own_scene("cornell-box", 32, 32);
    const RenderSettings settings = small_run();
    const RenderResult result = render(*scene, settings);
    const RenderStatistics& s = result.statistics;
    ASSERT_EQ(s.errors.block_means.size(), 256u);
    // A block is two by two pixels of a box filter.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            double mean = 0;
            for (const int i : {0, 1, 2, 3}) {
                const float* pixel = result.image.pixel(2 * x + i % 2, 2 * y + i / 2);
                mean += luminance({pixel[0], pixel[1], pixel[2]}) / 4;
            }
            EXPECT_NEAR(s.errors.block_means[16 * y + x], mean, 1e-4 * mean + 1e-6) << x << ", " << y;
        }
    EXPECT_NEAR(s.errors.luminance.effective_sample_size * s.errors.luminance.autocorrelation_time,
                static_cast<double>(s.mutations), 1e-6 * static_cast<double>(s.mutations));
    for (const StrategyStatistics& strategy : s.strategies)
        EXPECT_NEAR(strategy.position.effective_sample_size * strategy.position.autocorrelation_time,
                    static_cast<double>(strategy.proposals), 1e-6 * static_cast<double>(strategy.proposals));
    // An accepted large step forgets; a small one does not.
    EXPECT_LT(s.strategies[0].position.autocorrelation_time, s.strategies[1].position.autocorrelation_time);
}

TEST(ErrorStatistics, AreUnknownForOneChain) {
    const auto scene = own_scene("cornell-box", 8, 8);
    RenderSettings settings = small_run();
    settings.mix.chain_count = 1;
    settings.error_image = true;
    const RenderResult result = render(*scene, settings);
    EXPECT_EQ(result.statistics.errors.replicates, 1);
    EXPECT_TRUE(std::isinf(result.statistics.errors.image_mean));
    EXPECT_TRUE(std::isinf(result.error.rgb[0]));
    EXPECT_LT(result.statistics.errors.disagreeing_light, 0);
    EXPECT_TRUE(std::isinf(result.statistics.b_standard_error));
}

}  // namespace
}  // namespace keyhole
