// What the command does with options, scenes and outputs that are not valid: says what would have been, and writes
// nothing.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class BadInput : public CommandTest {
  protected:
    BadInput() { write("room.xml", room_scene); }
};

struct BadOption {
    std::vector<std::string> arguments;
    std::string message;
};

TEST_F(BadInput, OptionsAreRefusedWithWhatIsValid) {
    const std::vector<BadOption> cases = {
        {{}, "no command given"},
        {{"rendr", "room.xml"},
         "unknown command 'rendr'; did you mean 'render'? valid names: render, compare, sweep, tradeoff, diff, info"},
        {{"render"}, "SCENE is required"},
        {{"render", "room.xml", "--tim", "5s"}, "unknown option '--tim'; did you mean '--time'? valid names: "},
        {{"render", "room.xml", "extra.xml"}, "one argument too many: 'extra.xml'"},
        {{"render", "room.xml", "--time", "5x"},
         "--time: '5x' is not a duration; valid: a number with ms, s, m, h or d"},
        {{"render", "room.xml", "--time", "0s"}, "--time: '0s' is not above zero"},
        {{"render", "room.xml", "-n", "0"}, "--mutations-per-pixel: '0' is not valid here; valid: a number above 0"},
        {{"render", "room.xml", "-n", "nan"}, "--mutations-per-pixel: 'nan' is not valid here"},
        {{"render", "room.xml", "-n", "4", "--time", "5s"}, "--time and --mutations-per-pixel exclude each other"},
        {{"render", "room.xml", "--integrator", "mlt"},
         "unknown name 'mlt'; did you mean 'mmlt'? valid names: mmlt, bdpt, path"},
        {{"render", "room.xml", "--max-length", "0"},
         "--max-length: '0' is not valid here; valid: an integer from 1 to 256 edges or \"scene\""},
        {{"render", "room.xml", "--max-length", "2", "--min-length", "3"}, "'max' = 2 is below 'min' = 3"},
        {{"render", "room.xml", "--seed", "-1"}, "--seed: '-1' is not valid here; valid: an integer of at least 0"},
        {{"render", "room.xml", "--threads", "two"}, "--threads: 'two' is not valid here"},
        {{"render", "room.xml", "--size", "16"}, "--size: '16' is not a size; valid: WIDTHxHEIGHT"},
        {{"render", "room.xml", "--crop", "1,2,3"}, "--crop: '1,2,3' is not a crop window; valid: X,Y,WIDTH,HEIGHT"},
        {{"render", "room.xml", "--crop", "10,10,10,10"}, "crop"},
        {{"render", "room.xml", "-D", "light"}, "--define: 'light' is not a definition; valid: NAME=VALUE"},
        {{"render", "room.xml", "--chains", "5", "--integrator", "path"},
         "--chains has no effect here; it needs --integrator mmlt"},
        {{"render", "room.xml", "--bootstrap", "2"}, "--bootstrap: '2' is not valid here; valid: an integer from 4"},
        {{"render", "room.xml", "-q", "-v"}, "excludes"},
        {{"render", "room.xml", "-o", "a.jpg"}, "'a.jpg' has the unknown extension '.jpg'; valid extensions: .exr"},
        {{"render", "room.xml", "-o", "a"}, "'a' has no extension; valid extensions: .exr"},
        {{"render", "room.xml", "--mix", ""}, "valid names: auto, cmlt, "},
        {{"render", ""}, "SCENE is required"},
        {{"render", "."}, "'.' is not a file"},
        {{"info", "/dev/null"}, "'/dev/null' is not a file"},
        {{"render", "missing.xml"}, "missing.xml"},
        {{"info", "missing.xml"}, "missing.xml"},
        {{"diff", "room.xml"}, "REFERENCE is required"},
        {{"diff", "a.exr", "b.exr", "--metric", "psnr"}, "--metric: unknown name 'psnr'; valid names: mse, rmse"},
    };
    for (const BadOption& bad : cases) {
        std::string line = "keyhole";
        for (const std::string& argument : bad.arguments) line += " " + argument;
        const Finished done = run(bad.arguments);
        EXPECT_EQ(done.exit_code, 2) << line;
        EXPECT_THAT(done.err, HasSubstr("keyhole: error: ")) << line;
        EXPECT_THAT(done.err, HasSubstr(bad.message)) << line;
        EXPECT_EQ(done.out, "") << line;
        EXPECT_THAT(files(), ElementsAre("room.xml")) << line;
    }
}

TEST_F(BadInput, OutputsThatCannotBeWrittenAreFoundBeforeRendering) {
    write("plain", "x");
    std::filesystem::create_directory(path("folder.exr"));
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"none/a.exr", "cannot write 'none/a.exr': the folder 'none' does not exist"},
        {"plain/a.exr", "cannot write 'plain/a.exr'"},
        {"folder.exr", "cannot write 'folder.exr': it is a folder"},
        {"/proc/a.exr", "cannot write '/proc/a.exr'"},
    };
    for (const auto& [name, message] : cases) {
        // Rendered for an hour, this test would not end.
        const Finished done = run({"render", "room.xml", "--time", "1h", "-o", "fine.exr", "-o", name});
        EXPECT_EQ(done.exit_code, 1) << name;
        EXPECT_THAT(done.err, HasSubstr(message));
        EXPECT_THAT(files(), ElementsAre("folder.exr", "plain", "room.xml"));
    }
}

// Not by the system while the program fills the memory.
TEST_F(BadInput, WhatNoMemoryHoldsIsRefused) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--chains", "1000000000"},
          {"--size", "65536x65536", "--threads", "4096"},
          {"--size", "65536x65536", "--threads", "4096", "--integrator", "bdpt"}}) {
        std::vector<std::string> arguments = {"render", "room.xml", "-n", "4", "-o", "a.exr", "--max-length", "200"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished done = run(arguments);
        EXPECT_EQ(done.exit_code, 1) << more[1];
        EXPECT_THAT(done.err, HasSubstr("too little memory: the films of ")) << more[1];
        EXPECT_THAT(files(), ElementsAre("room.xml"));
    }
}

TEST_F(BadInput, AFullDiskUnderTheStandardOutputIsAFailure) {
    Process process(folder(), {"info", "room.xml"}, [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); });
    const Finished done = process.wait();
    EXPECT_EQ(done.exit_code, 1);
    EXPECT_THAT(done.err, HasSubstr("cannot write to the standard output"));
}

// The messages must not end up in a file that has got the number of a closed stream.
TEST_F(BadInput, ClosedStandardStreamsDoNoHarm) {
    Process process(folder(), quick_render("room.xml", {"-o", "a.exr", "-v"}), [] {
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(stream);
    });
    EXPECT_EQ(process.wait().exit_code, 0);
    EXPECT_EQ(read_image(path("a.exr").string()).width, 16);
    EXPECT_FALSE(json("a.json")["statistics"].empty());
}

TEST_F(BadInput, AnEarlierImageSurvivesABadScene) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.exr"})).exit_code, 0);
    const auto before = std::filesystem::last_write_time(path("a.exr"));
    write("room.xml", "<scene");
    EXPECT_EQ(run(quick_render("room.xml", {"-o", "a.exr"})).exit_code, 2);
    EXPECT_EQ(std::filesystem::last_write_time(path("a.exr")), before);
}

TEST_F(BadInput, LenientTurnsUnknownParametersIntoWarnings) {
    std::string scene = room_scene;
    scene.replace(scene.find("\"fov\""), 5, "\"fovv\"");
    write("room.xml", scene);
    const Finished done = run(quick_render("room.xml", {"-o", "a.exr", "--lenient", "--quiet"}));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("keyhole: warning: "));
    EXPECT_THAT(done.err, HasSubstr("fovv"));
    EXPECT_FALSE(json("a.json")["warnings"].empty());
}

TEST_F(BadInput, HelpTeachesAndIsNoError) {
    for (const char* command : {"render", "diff", "info"}) {
        const Finished done = run({command, "--help"});
        EXPECT_EQ(done.exit_code, 0);
        EXPECT_EQ(done.err, "");
        EXPECT_THAT(done.out, HasSubstr("Exit codes:"));
        EXPECT_THAT(done.out, HasSubstr(command));
    }
    const Finished help = run({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out,
                testing::AllOf(HasSubstr("render"), HasSubstr("diff"), HasSubstr("info"), HasSubstr("Exit codes:")));
    EXPECT_THAT(run({"render", "--help"}).out,
                testing::AllOf(HasSubstr("Examples:"), HasSubstr("--preview-every"), HasSubstr("--mix")));
    EXPECT_THAT(run({"--version"}).out,
                testing::MatchesRegex("keyhole [0-9.]+\ncompiler .*\nopenimageio .*\nembree .*\n"));
}

}  // namespace
}  // namespace keyhole
