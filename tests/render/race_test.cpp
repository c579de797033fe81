// The mix auto: what a race chooses, and that the render after it is one of the mix it chose.
#include "render/race.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "own_scenes.h"
#include "strategies/cones_bind.h"
#include "strategies/mix_states.h"

namespace keyhole {
namespace {

RenderSettings automatic(double mutations_per_pixel) {
    RenderSettings settings;
    settings.mix = builtin_mix("auto");
    settings.mix.chain_count = 128;
    settings.mix.bootstrap_samples = 20000;
    settings.mix.lengths.max = 6;
    settings.mutations_per_pixel = mutations_per_pixel;
    return settings;
}

// Only moves that apply to the scene, nothing left to tune; and the same image as by that mix alone.
TEST(Race, FindsAMixThatMakesTheSameImageAgain) {
    for (const char* name : {"cornell-box", "keyhole-room", "glossy-room"}) {
        const auto scene = own_scene(name, 32, 32);
        const RenderSettings settings = automatic(400);
        const RenderResult result = render(*scene, settings);
        ASSERT_TRUE(result.statistics.tuning);
        const Mix& mix = result.statistics.mix;
        EXPECT_EQ(mix.tuning, Mix::Tuning::off);
        for (const std::string& warning : result.statistics.warnings) EXPECT_FALSE(warning.starts_with("strategy"));
        for (const MixStrategy& s : mix.strategies) EXPECT_EQ(s.info->hindrance(*scene, mix.lengths), "") << name;

        RenderSettings again = settings;
        again.mix = parse_mix(write_mix(mix), "again");
        EXPECT_EQ(render(*scene, again).image.rgb, result.image.rgb) << name;
    }
}

// By numbers of mutations: whatever the threads and the time. Goes red if the cost of an error is counted in time.
TEST(Race, EndsInTheSameWayEachTime) {
    const auto scene = own_scene("four-holes", 24, 24);
    RenderSettings settings = automatic(2000);
    const auto order = [](const RenderResult& result) {
        std::vector<std::string> names;
        for (const auto& c : result.statistics.tuning->contenders) names.push_back(c.name);
        return names;
    };
    settings.threads = 1;
    const RenderResult one = render(*scene, settings);
    EXPECT_TRUE(one.statistics.tuning->clear);
    settings.threads = 3;
    const RenderResult three = render(*scene, settings);
    EXPECT_EQ(order(one), order(three));
    EXPECT_EQ(one.statistics.mix, three.statistics.mix);
    EXPECT_EQ(one.image.rgb, three.image.rgb);
}

// What the pool leaves out is not used, and the pool's parameters are.
TEST(Race, KeepsToThePool) {
    const auto scene = own_scene("cornell-box", 32, 32);
    RenderSettings settings = automatic(200);
    apply_settings(settings.mix, {{"lens-geo.weight", "0", ""}, {"small-step.s1", "1e-9", ""}});
    const RenderResult result = render(*scene, settings);
    for (const auto& c : result.statistics.tuning->contenders) EXPECT_FALSE(c.name.starts_with("fused-all"));
    for (const MixStrategy& s : result.statistics.mix.strategies) {
        EXPECT_NE(s.info->name, "lens-geo");
        if (s.info->name == "small-step") {
            EXPECT_LE(number(s.parameters, "s1"), 3e-9);
        }
    }
}

// Where light is hard to find, mixes without bidirectional mutations do not race.
TEST(Race, KnowsWhereLightIsHardToFind) {
    const auto races_fused = [](const char* name) {
        const TuningStatistics tuning = *render(*own_scene(name, 16, 16), automatic(100)).statistics.tuning;
        EXPECT_FALSE(tuning.contenders.empty());
        return std::any_of(tuning.contenders.begin(), tuning.contenders.end(),
                           [](const auto& c) { return c.name == "fused"; });
    };
    for (const char* easy : {"cornell-box", "glossy-room", "four-holes"}) EXPECT_TRUE(races_fused(easy)) << easy;
    for (const char* hard : {"keyhole-room", "box-in-the-sun", "ajar-door"}) EXPECT_FALSE(races_fused(hard)) << hard;
}

// Before a plane in the open every cone is as wide as it may be; in a room few are.
TEST(Race, LeavesConesOutWhereTheyNeverBind) {
    const std::string file = testing::TempDir() + "keyhole-open.xml";
    std::ofstream(file) << R"(<scene version="3.0.0">
        <sensor type="perspective"><transform name="to_world"><lookat origin="0 4 6" target="0 0 0" up="0 1 0"/></transform>
            <float name="fov" value="20"/>
            <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/></film></sensor>
        <shape type="rectangle"><transform name="to_world"><scale value="9"/><rotate x="1" angle="-90"/></transform></shape>
        <emitter type="point"><point name="position" x="1" y="5" z="0"/><rgb name="intensity" value="9"/></emitter>
    </scene>)";
    const auto bind = [](const Scene& scene) {
        const Mix mix = resolve(scene, automatic(1)).mix;
        const CoordinateLayout layout(scene, mix.lengths.max);
        TechniqueDistribution techniques = make_techniques(mix);
        const Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, mix);
        std::vector<const PssState*> paths;
        for (const ChainSeed& seed : bootstrap.groups[0].seeds) paths.push_back(&seed.state);
        const auto geo = std::find_if(mix.strategies.begin(), mix.strategies.end(),
                                      [](const MixStrategy& s) { return s.info->name == "lens-geo"; });
        return cones_bind(*geo, scene, paths);
    };
    const auto open = read_scene(file, {}).scene;
    EXPECT_FALSE(bind(*open));
    EXPECT_TRUE(bind(*own_scene("cornell-box")));
    for (const MixStrategy& s : render(*open, automatic(1)).statistics.mix.strategies) EXPECT_FALSE(s.info->cones);
}

// A pool that no set fits is what it is.
TEST(Race, NeedsSetsToRace) {
    const auto scene = own_scene("cornell-box", 16, 16);
    RenderSettings settings = automatic(20);
    const Mix own = parse_mix("tuning = \"race\"\n[[strategy]]\ntype = \"large-step\"\nweight = 1\n", "own");
    settings.mix.strategies = own.strategies;
    const RenderResult result = render(*scene, settings);
    EXPECT_TRUE(result.statistics.tuning->contenders.empty());
    EXPECT_EQ(result.statistics.mix.strategies, own.strategies);
}

// Steps that move nothing lose against moves that do.
TEST(Race, IsWonByMovesThatMove) {
    const auto scene = own_scene("four-holes", 16, 16);
    RenderSettings settings = automatic(20000);
    apply_settings(settings.mix, {{"large-step.weight", "0.1", ""},
                                  {"bidirectional.weight", "20", ""},
                                  {"small-step.s1", "1e-9", ""},
                                  {"small-step.s2", "2e-9", ""},
                                  {"lens.pixels-min", "1e-3", ""},
                                  {"lens.pixels-max", "2e-3", ""}});
    const TuningStatistics tuning = *render(*scene, settings).statistics.tuning;
    EXPECT_TRUE(tuning.clear);
    EXPECT_TRUE(tuning.winner.starts_with("fused-all")) << tuning.winner;
}

}  // namespace
}  // namespace keyhole
