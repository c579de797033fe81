// b of renders in which the bridge between samples and chains counts.
#include "chain/normalization.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "own_scenes.h"
#include "render/chain_run.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

class Bridge : public testing::TestWithParam<const char*> {};

// With twice b as the scale, half of the light counts for half or less, and all that is left of the bootstrap is where
// the chains start. b of the path tracer is known to 0.1%, that of the chains as its error says: by 15 replicates
// that are free to vary, 5 errors are a false alarm of 2e-4.
TEST_P(Bridge, AgreesWithThePathTracer) {
    const auto scene = own_scene("cornell-box", 24, 24);
    RenderSettings settings;
    const PathLengths lengths{2, 5};  // the lamp as it is seen directly is an island, which chains hardly leave
    settings.mix.lengths = lengths;
    settings.integrator = Integrator::path;
    settings.mutations_per_pixel = 4000;
    const double expected = render(*scene, settings).statistics.b;

    settings.integrator = Integrator::mmlt;
    settings.mix = builtin_mix(GetParam());
    settings.mix.lengths = lengths;
    settings = resolve(*scene, settings);
    const Mix& mix = settings.mix;
    const CoordinateLayout layout(*scene, mix.lengths.max);
    TechniqueDistribution techniques = make_techniques(mix);
    Bootstrap bootstrap = run_bootstrap(*scene, layout, techniques, mix);
    for (ChainGroup& group : bootstrap.groups) {
        group.bridge.scale = 2 * group.all().b();
        std::fill(group.b.begin(), group.b.end(), Normalization());
    }
    ChainRun run(*scene, settings, layout, techniques, std::move(bootstrap));
    for (std::uint64_t done = 0; done < 4000;) done += run.advance(4000 - done);
    RenderStatistics statistics;
    run.report(applicable_strategies(mix, *scene), statistics);
    EXPECT_NEAR(statistics.b, expected, 5 * statistics.b_standard_error);
    EXPECT_LT(statistics.b_standard_error, 0.02 * expected);
}

INSTANTIATE_TEST_SUITE_P(Mixes, Bridge, testing::Values("mmlt", "cmlt", "fused", "fused-all", "pssmlt"),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace keyhole
