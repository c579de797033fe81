// `keyhole render` when it is disturbed: signals, vanished folders and terminals.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class InterruptedRender : public CommandTest {
  protected:
    InterruptedRender() { write("room.xml", room_scene); }

    static std::vector<std::string> long_render() {
        return {"render", "--mix",           "mmlt", "room.xml",    "-o",   "a.exr",    "--time",
                "1h",     "--preview-every", "10ms", "--bootstrap", "4096", "--chains", "64"};
    }
    bool wait_for_preview(Process& process) const {
        return process.wait_until([this] { return fs::exists(path("a.exr")); });
    }
    Image image() const { return read_image(path("a.exr").string()); }
};

class InterruptedRenderSignal : public InterruptedRender, public testing::WithParamInterface<int> {};

TEST_P(InterruptedRenderSignal, WritesTheImageSoFar) {
    Process process(folder(), long_render());
    ASSERT_TRUE(wait_for_preview(process)) << process.err();
    process.signal(GetParam());
    const Finished done = process.wait();
    EXPECT_EQ(done.exit_code, 128 + GetParam()) << done.err;
    EXPECT_THAT(done.err, HasSubstr("finishing the current pass"));
    EXPECT_THAT(done.out, HasSubstr("interrupted"));
    EXPECT_THAT(files(), ElementsAre("a.exr", "a.json", "room.xml"));
    EXPECT_EQ(image().width, 16);
    EXPECT_EQ(json("a.json")["statistics"]["complete"], false);
    EXPECT_GT(json("a.json")["statistics"]["mutations"], 0);
}

INSTANTIATE_TEST_SUITE_P(All, InterruptedRenderSignal, testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& p) {
    return p.param == SIGINT ? "SIGINT" : p.param == SIGTERM ? "SIGTERM" : "SIGHUP";
});

TEST_F(InterruptedRender, SecondSignalQuitsAtOnceAndLeavesNoHalfFiles) {
    Process process(folder(), long_render());
    ASSERT_TRUE(wait_for_preview(process)) << process.err();
    process.signal(SIGINT);
    process.signal(SIGTERM);
    const int code = process.wait().exit_code;
    // The first may have ended the run already; then the second met a finished process or its last moments.
    EXPECT_TRUE(code == 128 + SIGTERM || code == 128 + SIGINT) << code;
    for (const std::string& name : files()) EXPECT_THAT(name, testing::Not(HasSubstr(".tmp")));
    EXPECT_EQ(image().width, 16);
}

TEST_F(InterruptedRender, PreviewIsReadableAtAnyTime) {
    Process process(folder(), long_render());
    ASSERT_TRUE(wait_for_preview(process)) << process.err();
    int reads = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
    while (std::chrono::steady_clock::now() < end) {
        ASSERT_EQ(image().height, 16);
        ++reads;
    }
    EXPECT_GT(reads, 10);
    process.signal(SIGTERM);
    EXPECT_EQ(process.wait().exit_code, 143);
}

TEST_F(InterruptedRender, IgnoredSignalsStayIgnored) {
    Process process(folder(), long_render(), [] { ::signal(SIGHUP, SIG_IGN); });
    ASSERT_TRUE(wait_for_preview(process)) << process.err();
    process.signal(SIGHUP);
    process.signal(SIGTERM);
    EXPECT_EQ(process.wait().exit_code, 143);
}

// As with `keyhole render ... 2>&1 | tee log`, where Ctrl-C ends `tee` first.
TEST_F(InterruptedRender, SurvivesAReaderThatHasGone) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    auto arguments = long_render();
    arguments.push_back("-v");
    Process process(folder(), arguments, [&] {
        close(ends[0]);
        dup2(ends[1], STDERR_FILENO);
        dup2(ends[1], STDOUT_FILENO);
        close(ends[1]);
    });
    close(ends[1]);
    ASSERT_TRUE(wait_for_preview(process));
    close(ends[0]);
    process.signal(SIGINT);
    process.wait();  // whatever the exit code, since there was nobody to write to
    EXPECT_EQ(image().width, 16);
    EXPECT_EQ(json("a.json")["statistics"]["complete"], false);
}

TEST_F(InterruptedRender, ImageIsRescuedWhenItsFolderVanishes) {
    fs::create_directory(path("out"));
    fs::create_directory(path("tmp"));
    std::ofstream(path("tmp/a.exr")) << "somebody else's";
    auto arguments = long_render();
    arguments[5] = "out/a.exr";
    Process process(folder(), arguments, [this] { setenv("TMPDIR", path("tmp").c_str(), 1); });
    ASSERT_TRUE(process.wait_until([this] { return fs::exists(path("out/a.exr")); })) << process.err();
    fs::rename(path("out"), path("elsewhere"));
    ASSERT_TRUE(process.wait_until([&] { return process.err().find("no preview") != std::string::npos; }));
    process.signal(SIGINT);
    const Finished done = process.wait();
    EXPECT_EQ(done.exit_code, 1);
    EXPECT_THAT(done.err, HasSubstr("it was written to '" + path("tmp/a-1.exr").string() + "' instead"));
    EXPECT_EQ(read_image(path("tmp/a-1.exr").string()).width, 16);
    EXPECT_EQ(json("tmp/a.json")["statistics"]["complete"], false);
}

}  // namespace
}  // namespace keyhole
