// path, bdpt and the mixes converge to one image, on the project's own scenes, which together hold every plugin of the
// reader (tests/scene/own_scenes_test.cpp).
#include "own_scenes.h"
#include "render/replicates.h"

namespace keyhole {
namespace {

// False-alarm level of the whole file. Each scene makes three comparisons.
constexpr double family_level = 1e-3;

class Agrees : public testing::TestWithParam<TransportCase> {};

TEST_P(Agrees, WithBidirectionalPathTracing) {
    const TransportCase& c = GetParam();
    const auto scene = own_scene(c, 12, 12);
    constexpr int runs = 12;
    const double level = sidak_level(family_level, 3 * static_cast<int>(transport_cases().size()));

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
    settings.mutations_per_pixel = 4000;
    for (const char* name : {"mmlt", "rjmlt", "cmlt", "cmlt-gibbs", "cmlt-ipsm", "cmlt-exchange", "pssmlt", "pssmlt-mix"}) {
        const PathLengths lengths = settings.mix.lengths;
        settings.mix = builtin_mix(name);
        settings.mix.lengths = lengths;
        settings.mix.chain_count = 64;
        settings.mix.bootstrap_samples = 40000;
        expect_agreement(render_replicates(*scene, settings, runs), bdpt, level, c.scene + "-" + name);
    }
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Agrees, testing::ValuesIn(transport_cases()), test_name_of_case);

}  // namespace
}  // namespace keyhole
