// Strategy mixes on the command line.
#include <gmock/gmock.h>

#include "harness.h"

namespace keyhole {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MixesCommand : public CommandTest {
  protected:
    MixesCommand() { write("room.xml", room_scene); }
};

TEST_F(MixesCommand, ListsPrintsAndExplains) {
    const Finished list = run({"mixes"});
    EXPECT_EQ(list.exit_code, 0);
    EXPECT_THAT(list.out, AllOf(HasSubstr("mmlt  "), HasSubstr("mmlt-gaussian  ")));
    const Finished show = run({"mixes", "show", "mmlt"});
    EXPECT_EQ(show.exit_code, 0);
    EXPECT_THAT(show.out, AllOf(HasSubstr("name = \"mmlt\""), HasSubstr("[[strategy]]\ntype = \"small-step\"")));
    EXPECT_THAT(run({"mixes", "strategies"}).out,
                AllOf(HasSubstr("large-step\n"), HasSubstr("reaches every path"), HasSubstr("[default: 0.015625]")));
}

TEST_F(MixesCommand, AMixThatWasPrintedIsAMixFile) {
    write("mine.toml", run({"mixes", "show", "mmlt-gaussian"}).out);
    EXPECT_EQ(run({"mixes", "show", "mine.toml"}).out, run({"mixes", "show", "mmlt-gaussian"}).out);
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.exr", "--mix", "mine.toml"})).exit_code, 0);
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "b.exr", "--mix", "mmlt-gaussian"})).exit_code, 0);
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "c.exr", "--mix", "mmlt", "--set", "small-step.kernel=gaussian"}))
                  .exit_code,
              0);
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "d.exr"})).exit_code, 0);
    const auto b = [&](const char* name) { return json(name)["statistics"]["b"]; };
    EXPECT_EQ(b("a.json"), b("b.json"));
    EXPECT_EQ(b("a.json"), b("c.json"));
    EXPECT_NE(b("a.json"), b("d.json"));
}

TEST_F(MixesCommand, SettingsAndTheirOwnOptionsEndUpInTheReport) {
    const Finished done = run({"render",       "room.xml",
                               "--mix",        "mmlt",
                               "-n",           "4",
                               "--bootstrap",  "4096",
                               "-o",           "a.exr",
                               "--set",        "large-step.weight=0.5",
                               "--set",        "lengths.per-chain=fixed",
                               "--set",        "chains.count=9",
                               "--chains",     "24",
                               "--seed",       "7",
                               "--max-length", "4"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json report = json("a.json");
    EXPECT_THAT(report["settings"]["mix"].get<std::string>(),
                AllOf(HasSubstr("seed = 7\n"), HasSubstr("max = 4\n"), HasSubstr("count = 24\n"),
                      HasSubstr("per-chain = \"fixed\"\n"), HasSubstr("type = \"large-step\"\nweight = 0.5\n")));
    EXPECT_EQ(report["statistics"]["chains"], 24);
    EXPECT_EQ(report["statistics"]["lengths"].size(), 3u);  // the light is out of sight
}

TEST_F(MixesCommand, SaysWhatIsWrong) {
    write("bad.toml", "[[strategy]]\ntype = \"large-step\"\nweight = -1\n");
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"mixes", "show"}, "MIX is required"},
        {{"mixes", "sow", "mmlt"}, "unknown command 'sow'; did you mean 'show'? valid names: show, strategies"},
        {{"mixes", "show", "mmmlt"},
         "unknown mix 'mmmlt'; did you mean 'mmlt'? valid names: auto, cmlt, cmlt-exchange, "},
        {{"mixes", "show", "bad.toml"}, "bad.toml:3:10: 'weight' cannot be -1; valid: a number from 0"},
        {{"render", "room.xml", "--mix", "bad.toml"}, "bad.toml:3:10: "},
        {{"render", "room.xml", "--mix", "none.toml"}, "none.toml: the mix file cannot be read"},
        {{"render", "room.xml", "--set", "sigma"}, "--set: 'sigma' is not a setting; valid: KEY=VALUE"},
        {{"render", "room.xml", "--set", "small-step.sgima=1"}, "--set: unknown key 'small-step.sgima'; did you mean"},
        {{"render", "room.xml", "--set", "small-step.sigma=0.1"}, "it needs small-step.kernel=gaussian"},
        {{"render", "room.xml", "--set", "small-step.s1=0.5"}, "small-step: s1 = 0.5 is above s2 = 0.015625"},
        {{"render", "room.xml", "--mix", "mmlt", "--set", "large-step.weight=0"},
         "no strategy of positive weight reaches every path"},
        {{"render", "room.xml", "--set", "walk-steps=3"},
         "--set: walk-steps has no effect here; it needs rectification=walk-on"},
        {{"render", "room.xml", "--set", "lengths.per-chain=fixed", "--chains", "2"},
         "2 chains of fixed length are too"},
        {{"render", "room.xml", "-i", "path", "--set", "chains.count=5"},
         "--set chains.count has no effect here; it needs --integrator mmlt"},
        {{"render", "room.xml", "-i", "bdpt", "--mix", "mmlt"}, "--mix has no effect here; it needs --integrator mmlt"},
        {{"bench", "room.xml", "--set", "small-step.s1=2"},
         "--set: '2' is not valid here; valid: a number above 0 to 0.5"},
    };
    for (const auto& [arguments, message] : cases) {
        const Finished done = run(arguments);
        EXPECT_EQ(done.exit_code, 2) << message;
        EXPECT_THAT(done.err, HasSubstr(message));
    }
    EXPECT_THAT(files(), testing::ElementsAre("bad.toml", "room.xml"));
}

}  // namespace
}  // namespace keyhole
