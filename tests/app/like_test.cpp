// `keyhole render --like`: an image made again from itself.
#include <gmock/gmock.h>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::HasSubstr;
using testing::Not;

class Like : public CommandTest {
  protected:
    Like() { write("room.xml", room_scene); }
    std::vector<float> pixels(const std::string& name) const { return read_image(path(name).string()).rgb; }
    void make(const std::vector<std::string>& arguments) const {
        const Finished done = run(arguments);
        ASSERT_EQ(done.exit_code, 0) << done.err;
    }
    // Renders `original` and makes it again.
    void expect_the_same(std::vector<std::string> original) const {
        for (const char* argument : {"-o", "out.exr", "-o", "out.png"}) original.emplace_back(argument);
        make(original);
        for (const char* source : {"out.exr", "out.png", "out.json"}) {
            make({"render", "--like", source, "-o", "again.exr", "--threads", "1"});
            EXPECT_EQ(pixels("again.exr"), pixels("out.exr")) << source;
            EXPECT_EQ(json("again.json")["statistics"]["mutations"], json("out.json")["statistics"]["mutations"]);
            EXPECT_EQ(json("again.json")["warnings"], json("out.json")["warnings"]);
        }
    }
};

TEST_F(Like, MakesTheSameBits) {
    expect_the_same({"render",       "room.xml",
                     "-n",           "7",
                     "--bootstrap",  "4096",
                     "--seed",       "5",
                     "-D",           "light=3",
                     "--size",       "20x10",
                     "--crop",       "3,2,13,7",
                     "--chains",     "33",
                     "--max-length", "4",
                     "--set",        "small-step.kernel=gaussian",
                     "--set",        "target=max-channel"});
    expect_the_same({"render", "room.xml", "-n", "7", "--bootstrap", "4096", "--set", "lengths.per-chain=fixed",
                     "--filter", "box"});
    for (const char* integrator : {"path", "bdpt"})
        expect_the_same({"render", "room.xml", "-n", "3", "-i", integrator, "--seed", "9", "--min-length", "2"});
}

TEST_F(Like, RepeatsWhatARunOfAGivenTimeHasMade) {
    expect_the_same({"render", "room.xml", "--time", "300ms", "--bootstrap", "65536", "--size", "8x8"});
    expect_the_same({"render", "room.xml", "--time", "100ms", "-i", "bdpt", "--size", "8x8"});
}

TEST_F(Like, TakesItsMixFromTheImageNotFromTheFile) {
    write("mine.toml", run({"mixes", "show", "mmlt"}).out);
    make(quick_render("room.xml", {"--mix", "mine.toml", "-o", "out.exr"}));
    std::filesystem::remove(path("mine.toml"));
    make({"render", "--like", "out.exr", "-o", "again.exr"});
    EXPECT_EQ(pixels("again.exr"), pixels("out.exr"));
    EXPECT_EQ(read_metadata(path("out.exr").string(), "keyhole:mix"), json("again.json")["settings"]["mix"]);
}

TEST_F(Like, OtherOptionsChangeTheRun) {
    make(quick_render("room.xml", {"-o", "out.exr", "--size", "20x10", "--crop", "3,2,13,7", "--seed", "3"}));
    make({"render", "--like", "out.exr", "-o", "again.exr", "--seed", "4", "--size", "9x8", "-n", "5"});
    EXPECT_NE(pixels("again.exr"), pixels("out.exr"));
    EXPECT_EQ(json("again.json")["settings"]["seed"], 4);
    EXPECT_EQ(json("again.json")["settings"]["mutations_per_pixel"], 5);
    EXPECT_EQ(json("again.json")["film"]["crop"], (std::vector<int>{0, 0, 9, 8}));
}

TEST_F(Like, FindsTheSceneAgainAndWarnsOfChanges) {
    make(quick_render("room.xml", {"-o", "out.exr"}));
    std::filesystem::rename(path("room.xml"), path("moved.xml"));
    const Finished lost = run({"render", "--like", "out.exr", "-o", "again.exr"});
    EXPECT_EQ(lost.exit_code, 2);
    EXPECT_THAT(lost.err, HasSubstr("room.xml"));
    const Finished found = run({"render", "moved.xml", "--like", "out.exr", "-o", "again.exr", "--quiet"});
    EXPECT_EQ(found.err, "");
    EXPECT_EQ(pixels("again.exr"), pixels("out.exr"));
    std::string scene = room_scene;
    scene.replace(scene.find("value=\"60\""), 10, "value=\"50\"");
    write("room.xml", scene);
    const Finished changed = run({"render", "--like", "out.exr", "-o", "again.exr", "--quiet"});
    EXPECT_EQ(changed.exit_code, 0);
    EXPECT_THAT(changed.err, HasSubstr("the scene is not the one that 'out.exr' was made of"));
    EXPECT_NE(pixels("again.exr"), pixels("out.exr"));
}

TEST_F(Like, RefusesWhatSaysTooLittle) {
    make(quick_render("room.xml", {"-o", "out.exr"}));
    write_image(path("plain.exr").string(), Image(2, 2));
    write("broken.json", "{\"scene\": ");
    write("small.json", "{\"scene\": {}}");
    nlohmann::json preview = json("out.json");
    preview.erase("statistics");
    write("preview.json", preview.dump());
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"render", "--like", "out.exr"}, "--like needs -o"},
        {{"render", "-o", "again.exr"}, "SCENE is required"},
        {{"render", "--like", "none.exr", "-o", "again.exr"}, "none.exr: cannot read the image"},
        {{"render", "--like", "none.json", "-o", "again.exr"}, "none.json: the report cannot be read"},
        {{"render", "--like", "plain.exr", "-o", "again.exr"}, "plain.exr: the image does not say how it was made"},
        {{"render", "--like", "broken.json", "-o", "again.exr"}, "broken.json: no complete description of a run"},
        {{"render", "--like", "small.json", "-o", "again.exr"}, "small.json: no complete description of a run"},
        {{"render", "--like", "preview.json", "-o", "again.exr"}, "preview.json: this is a preview"},
    };
    for (const auto& [arguments, message] : cases) {
        const Finished done = run(arguments);
        EXPECT_EQ(done.exit_code, 2) << message;
        EXPECT_THAT(done.err, HasSubstr(message));
    }
    EXPECT_THAT(files(), Not(testing::Contains("again.exr")));
}

}  // namespace
}  // namespace keyhole
