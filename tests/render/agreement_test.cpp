// path, bdpt and mmlt converge to one image, on the project's own scenes, which together hold every BSDF, emitter, sensor
// and texture of the reader.
#include "own_scenes.h"
#include "render/replicates.h"

namespace keyhole {
namespace {

// False-alarm level of the whole file. Each scene makes up to two comparisons.
constexpr double family_level = 1e-3;

struct Case {
    const char* scene;
    std::map<std::string, std::string> defines;  // wider openings, so that path tracing converges as well
    int max_length = 5;
    bool path_finds_all = true;  // false: some light comes only from emitters without extent through delta lobes
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

const Case cases[] = {
    {"cornell-box", {}},
    {"three-planes", {{"hole", "0.1"}}},
    {"four-holes", {}},
    {"keyhole-room", {{"hole", "0.4"}}},
    {"ajar-door", {{"door", "60"}}},
    {"box-in-the-sun", {{"hole", "0.3"}}},
    {"blinds", {{"tilt", "30"}}},
    {"glossy-room", {}},
    {"glass-caustic", {{"light", "0.5"}}},
    {"charted-toy", {{"hole", "0.1"}}},
    {"stage", {}},
    {"gallery", {}},
    {"veil", {}},
};

class Agrees : public testing::TestWithParam<Case> {};

TEST_P(Agrees, WithBidirectionalPathTracing) {
    const Case& c = GetParam();
    const auto scene = own_scene(c.scene, 12, 12, c.defines);
    constexpr int runs = 12;
    const double level = sidak_level(family_level, 2 * static_cast<int>(std::size(cases)));

    RenderSettings settings;
    settings.mix.lengths.max = c.max_length;
    settings.integrator = Integrator::bdpt;
    settings.mutations_per_pixel = 400;
    const Replicates bdpt = render_replicates(*scene, settings, runs);
    EXPECT_GT(bdpt.mean(bdpt.sum.size() - 1), 0);

    settings.integrator = Integrator::mmlt;
    settings.mutations_per_pixel = 4000;
    settings.mix.chain_count = 64;
    settings.mix.bootstrap_samples = 40000;
    expect_agreement(render_replicates(*scene, settings, runs), bdpt, level, std::string(c.scene) + "-mmlt");

    if (!c.path_finds_all) return;
    settings.integrator = Integrator::path;
    settings.mutations_per_pixel = 2000;
    expect_agreement(render_replicates(*scene, settings, runs), bdpt, level, std::string(c.scene) + "-path");
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, Agrees, testing::ValuesIn(cases),
                         [](const auto& test) { return test_name_of(test.param.scene); });

}  // namespace
}  // namespace keyhole
