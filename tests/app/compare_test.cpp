// `keyhole compare` and `keyhole sweep`.
#include <gmock/gmock.h>
#include <signal.h>

#include <set>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class Compare : public CommandTest {
  protected:
    Compare() { write("room.xml", room_scene); }

    // A comparison that is over in a moment.
    static std::vector<std::string> quick(std::vector<std::string> more) {
        std::vector<std::string> all = {
            "compare", "room.xml",         "--size", "8x8",   "--max-length",           "4",  "-n", "16", "--runs",
            "2",       "--reference-time", "200ms",  "--set", "bootstrap.samples=4096", "-o", "out"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::set<std::string> entry_names(const std::string& results) const {
        std::set<std::string> names;
        const nlohmann::json all = json(results);
        for (const auto& entry : all["entries"]) names.insert(entry["name"]);
        return names;
    }
    void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
        const Finished done = run(arguments);
        EXPECT_EQ(done.exit_code, 2) << done.err;
        EXPECT_THAT(done.err, HasSubstr(message));
        EXPECT_FALSE(std::filesystem::exists(path("out")));
    }
};

TEST_F(Compare, MixesAndIntegrators) {
    write("mine.toml", run({"mixes", "show", "mmlt-gaussian"}).out);
    const Finished done = run(quick({"--mixes", "mmlt,mine.toml", "--integrators", "path,bdpt"}));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, AllOf(HasSubstr("speed-up"), HasSubstr("mmlt-gaussian"), HasSubstr("wrote out/index.html")));
    EXPECT_EQ(entry_names("out/results.json"), (std::set<std::string>{"bdpt", "mmlt", "mmlt-gaussian", "path"}));
    const auto results = json("out/results.json");
    EXPECT_EQ(results["scene"]["max_length"], 4);
    EXPECT_EQ(results["equal"], "mutations");
    EXPECT_THAT(results["command"].get<std::string>(), HasSubstr("keyhole compare room.xml --size 8x8"));
    EXPECT_EQ(results["entries"][0]["metrics"]["relmse"]["mean"].is_number(), true);
    EXPECT_THAT(files(), testing::Contains("out"));
}

TEST_F(Compare, TradeoffTurnsEachKnob) {
    std::vector<std::string> arguments = quick({"--mix", "fused-geo", "--knobs", "cones,rectification,robust"});
    arguments[0] = "tradeoff";
    const Finished done = run(arguments);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, AllOf(HasSubstr("cones: "), HasSubstr("rectification: "), HasSubstr("robust: ")));
    EXPECT_EQ(entry_names("out/results.json"),
              (std::set<std::string>{"fused-geo", "cones=bvh-cut 5", "cones=bvh-cut 20", "cones=bvh-cut 40",
                                     "cones=fast", "cones=exact", "rectification=exclude", "rectification=walk-on",
                                     "rectification=retry", "robust=on"}));
    const auto results = json("out/results.json");
    ASSERT_EQ(results["tradeoff"].size(), 3u);
    EXPECT_EQ(results["tradeoff"][0]["settings"].size(), 6u);

    arguments[arguments.size() - 1] = "cone";
    EXPECT_THAT(run(arguments).err, HasSubstr("unknown knob 'cone'"));
    arguments[arguments.size() - 3] = "mmlt";
    arguments[arguments.size() - 1] = "cones";
    EXPECT_THAT(run(arguments).err, HasSubstr("has none of these knobs"));
}

// The mix auto may be another one in each run.
TEST_F(Compare, AutoIsAnEntryLikeAnother) {
    const Finished done = run(quick({"--mixes", "mmlt,auto"}));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(entry_names("out/results.json"), (std::set<std::string>{"mmlt", "auto"}));
    ASSERT_EQ(run({"render", "--like", "out/runs/auto/run-2.exr", "-o", "again.exr"}).exit_code, 0);
    EXPECT_EQ(read_image(path("again.exr")).rgb, read_image(path("out/runs/auto/run-2.exr")).rgb);
    EXPECT_THAT(run({"sweep", "room.xml", "--mix", "auto", "--vary", "large-step.weight=1,2"}).err,
                HasSubstr("is found by a race in a render"));
}

// An image of a run can be made again from itself.
TEST_F(Compare, ImagesAreThoseOfRender) {
    ASSERT_EQ(run(quick({"--mixes", "mmlt"})).exit_code, 0);
    const Finished again = run({"render", "--like", "out/runs/mmlt/run-2.exr", "-o", "again.exr"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_image(path("again.exr").string()).rgb, read_image(path("out/runs/mmlt/run-2.exr").string()).rgb);
}

TEST_F(Compare, GoesOnAfterCtrlC) {
    std::vector<std::string> arguments = quick({"--mixes", "mmlt", "--integrators", "path"});
    for (std::string& argument : arguments)
        if (argument == "16") argument = "200000";  // longer than anyone waits
    Process process(folder(), arguments);
    ASSERT_TRUE(process.wait_until([&] { return process.err().find("run 1/2 mmlt") != std::string::npos; }));
    process.signal(SIGINT);
    const Finished stopped = process.wait();
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_THAT(stopped.out, HasSubstr("the same command goes on from here"));
    EXPECT_EQ(json("out/results.json")["entries"][0]["runs"], 0);

    const Finished other = run(quick({"--mixes", "mmlt", "--integrators", "path"}));
    EXPECT_EQ(other.exit_code, 0) << other.err << "no run was complete, so none is in the way";
    EXPECT_EQ(json("out/results.json")["entries"][1]["runs"], 2);

    const Finished changed = run(quick({"--mixes", "mmlt", "--integrators", "path", "--set", "large-step.weight=3"}));
    EXPECT_EQ(changed.exit_code, 2);
    EXPECT_THAT(changed.err, AllOf(HasSubstr("'mmlt'"), HasSubstr("mix"), HasSubstr("--discard")));
    EXPECT_EQ(run(quick({"--mixes", "mmlt", "--set", "large-step.weight=3", "--discard", "-q"})).exit_code, 0);
}

TEST_F(Compare, TakesAReferenceOfAnyOrigin) {
    ASSERT_EQ(run({"render", "room.xml", "-i", "bdpt", "-n", "64", "--size", "8x8", "-o", "ref.exr"}).exit_code, 0);
    std::vector<std::string> arguments = quick({"--mixes", "mmlt", "--reference", "ref.exr"});
    arguments.erase(std::find(arguments.begin(), arguments.end(), "--reference-time"));
    arguments.erase(std::find(arguments.begin(), arguments.end(), "200ms"));
    const Finished done = run(arguments);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("how noisy the reference is is not known"));
    EXPECT_EQ(json("out/results.json")["reference"]["file"], "../ref.exr");
    arguments[3] = "9x9";
    arguments.emplace_back("--discard");
    const Finished other = run(arguments);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.err, HasSubstr("is 8x8 pixels; the scene's film is 9x9"));
    EXPECT_TRUE(std::filesystem::exists(path("out/runs/mmlt/run-1.json"))) << "nothing is deleted for an error";
}

TEST_F(Compare, RefusesWhatMakesNoSense) {
    expect_refused(quick({}), "nothing to compare");
    expect_refused(quick({"--mixes", "mmlt,"}), "empty name");
    expect_refused(quick({"--mixes", "mmmlt"}), "did you mean 'mmlt'");
    expect_refused(quick({"--mixes", "mmlt,mmlt"}), "two entries");
    expect_refused(quick({"--integrators", "pth"}), "did you mean 'path'");
    expect_refused(quick({"--mixes", "mmlt", "--time", "1s", "--equal", "time"}),
                   "--mutations-per-pixel has no effect");
    expect_refused(quick({"--mixes", "mmlt", "--runs", "0"}), "--runs");
    expect_refused(quick({"--mixes", "mmlt", "--reference", "ref.exr"}), "--reference");
    expect_refused({"compare", "room.xml", "--mixes", "mmlt", "--equal", "mutations", "-o", "out"},
                   "needs their number");
    expect_refused({"compare", "none.xml", "--mixes", "mmlt", "-o", "out"}, "none.xml");
    write("taken", "");
    EXPECT_EQ(run({"compare", "room.xml", "--mixes", "mmlt", "-o", "taken/out"}).exit_code, 1);
}

TEST_F(Compare, SweepsAParameter) {
    std::vector<std::string> arguments = quick({"--mix", "mmlt-gaussian", "--vary", "small-step.sigma=0.001..0.1"});
    arguments[0] = "sweep";
    arguments.insert(arguments.end(), {"--steps", "3"});
    const Finished done = run(arguments);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const auto entries = json("out/results.json")["entries"];
    ASSERT_EQ(entries.size(), 3u);
    EXPECT_EQ(entries[1]["name"], "small-step.sigma=0.01");
    EXPECT_EQ(entries[1]["parameter"], (nlohmann::json{{"name", "small-step.sigma"}, {"value", 0.01}}));
    EXPECT_THAT(entries[1]["mix"].get<std::string>(), HasSubstr("sigma = 0.01"));
}

TEST_F(Compare, SweepsIntegersAndNames) {
    std::vector<std::string> arguments = quick({"--vary", "chains.count=16..64", "--steps", "3"});
    arguments[0] = "sweep";
    EXPECT_EQ(run(arguments).exit_code, 0);
    EXPECT_EQ(entry_names("out/results.json"),
              (std::set<std::string>{"chains.count=16", "chains.count=32", "chains.count=64"}));
    arguments = quick({"--vary", "small-step.kernel=kelemen,gaussian", "--discard"});
    arguments[0] = "sweep";
    EXPECT_EQ(run(arguments).exit_code, 0);
    EXPECT_FALSE(json("out/results.json")["entries"][0].contains("parameter"));
}

TEST_F(Compare, SweepRefusesWhatIsNotARange) {
    const auto sweep = [](const std::string& range) {
        return std::vector<std::string>{"sweep", "room.xml", "--vary", range, "-o", "out"};
    };
    expect_refused(sweep("small-step.sigma"), "not a range");
    expect_refused(sweep("small-step.s2=0.001..x"), "x");
    expect_refused(sweep("small-step.s3=0.1,0.2"), "small-step.s3");
    expect_refused(sweep("small-step.s2=0.1..7"), "--vary");
}

}  // namespace
}  // namespace keyhole
