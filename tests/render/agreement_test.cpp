// path, bdpt and the mixes converge to one image, on the project's own scenes, which together hold every plugin of the
// reader (tests/scene/own_scenes_test.cpp).
#include "own_scenes.h"
#include "render/replicates.h"

namespace keyhole {
namespace {

struct MixCase {
    Mix mix;
    double mutations_per_pixel;
};

// All built-in mixes that are exact, the two oldest in more detail, and one for the policy that none of them has.
const std::vector<MixCase>& exact_mixes() {
    static const std::vector<MixCase> cases = [] {
        std::vector<MixCase> all;
        for (const Mix& mix : builtin_mixes())
            if (mix.rectification.policy != Rectification::exclude)
                all.push_back({mix, mix.name == "mmlt" || mix.name == "rjmlt" ? 4000.0 : 1500.0});
        Mix retry = builtin_mix("mmlt");
        retry.name = "mmlt-retry";
        retry.rectification.policy = Rectification::retry;
        all.push_back({retry, 1500});
        return all;
    }();
    return cases;
}

// False-alarm level of the whole file.
constexpr double family_level = 1e-3;

class Agrees : public testing::TestWithParam<TransportCase> {};

TEST_P(Agrees, WithBidirectionalPathTracing) {
    const TransportCase& c = GetParam();
    const auto scene = own_scene(c, 12, 12);
    constexpr int runs = 12;
    const int comparisons = static_cast<int>((1 + exact_mixes().size()) * transport_cases().size());
    const double level = sidak_level(family_level, comparisons);

    RenderSettings settings;
    settings.mix.lengths.max = c.max_length;
    settings.integrator = Integrator::bdpt;
    settings.mutations_per_pixel = 400;
    const Replicates bdpt = render_replicates(*scene, settings, runs);
    EXPECT_GT(bdpt.mean(bdpt.sum.size() - 1), 0);

    settings.integrator = Integrator::path;
    settings.mutations_per_pixel = 2000;
    expect_agreement(render_replicates(*scene, settings, runs), bdpt, level, c.scene + "-path");

    settings.integrator = Integrator::mmlt;
    for (const MixCase& mix : exact_mixes()) {
        const PathLengths lengths = settings.mix.lengths;
        settings.mix = mix.mix;
        settings.mix.lengths = lengths;
        settings.mix.chain_count = 64;
        settings.mix.bootstrap_samples = 40000;
        settings.mutations_per_pixel = mix.mutations_per_pixel;
        expect_agreement(render_replicates(*scene, settings, runs), bdpt, level, c.scene + "-" + settings.mix.name);
    }
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Agrees, testing::ValuesIn(transport_cases()), test_name_of_case);

}  // namespace
}  // namespace keyhole
