// `keyhole render`: what it writes and says.
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmath>
#include <numeric>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class RenderCommand : public CommandTest {
  protected:
    RenderCommand() { write("room.xml", room_scene); }

    Image image(const std::string& name) const { return read_image(path(name).string()); }
    std::string attribute(const std::string& image_name, const std::string& key) const {
        const auto input = OIIO::ImageInput::open(path(image_name).string());
        return input ? std::string(input->spec().get_string_attribute(key)) : "unreadable";
    }
};

double mean(const Image& image) {
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0) / static_cast<double>(image.rgb.size());
}

class RenderCommandIntegrator : public RenderCommand, public testing::WithParamInterface<const char*> {};

TEST_P(RenderCommandIntegrator, WritesImagesAndReport) {
    const std::string integrator = GetParam();
    std::vector<std::string> more = {"--integrator", integrator, "-o", "a.exr", "-o", "a.png"};
    if (integrator == "mmlt")
        more.insert(more.end(), {"--set", "bootstrap.most-starts=1"});  // else the run is too short
    const Finished done = run(quick_render("room.xml", more));
    ASSERT_EQ(done.exit_code, 0) << done.err;
    std::vector<std::string> expected = {"a.exr", "a.json", "a.png", "room.xml"};
    if (integrator == "mmlt") expected.insert(expected.begin() + 2, "a.mix.toml");  // the mix that was found
    EXPECT_EQ(files(), expected);
    EXPECT_THAT(done.out, AllOf(HasSubstr("wrote a.exr"), HasSubstr("wrote a.png"), HasSubstr("wrote a.json")));

    for (const char* name : {"a.exr", "a.png"}) {
        const Image picture = image(name);
        EXPECT_EQ(picture.width, 16);
        EXPECT_EQ(picture.height, 16);
        for (const float v : picture.rgb) ASSERT_TRUE(std::isfinite(v) && v >= 0);
        EXPECT_GT(mean(picture), 0);
        EXPECT_EQ(attribute(name, "keyhole:integrator"), integrator);
        EXPECT_EQ(attribute(name, "keyhole:scene"), "room.xml");
        EXPECT_EQ(attribute(name, "keyhole:complete"), "true");
    }
    const nlohmann::json report = json("a.json");
    EXPECT_EQ(nlohmann::json::parse(attribute("a.exr", "keyhole:run")), report);
    EXPECT_EQ(report["settings"]["integrator"], integrator);
    EXPECT_EQ(report["settings"]["mutations_per_pixel"], 4);
    EXPECT_EQ(report["film"]["width"], 16);
    EXPECT_EQ(report["warnings"], nlohmann::json::array());
    EXPECT_TRUE(report["versions"].contains("keyhole"));
    const nlohmann::json& statistics = report["statistics"];
    EXPECT_EQ(statistics["complete"], true);
    EXPECT_GE(statistics["mutations"], 4 * 256);
    EXPECT_EQ(statistics["max_length"], 5);
    EXPECT_GT(statistics["b"], 0);
    EXPECT_GT(statistics["rays"], 0);
    EXPECT_GT(statistics["peak_memory_bytes"], 1 << 20);
    EXPECT_EQ(statistics["non_finite"], 0);
    EXPECT_EQ(statistics.contains("acceptance"), integrator == "mmlt");
}

INSTANTIATE_TEST_SUITE_P(All, RenderCommandIntegrator, testing::Values("mmlt", "bdpt", "path"),
                         [](const auto& p) { return std::string(p.param); });

TEST_F(RenderCommand, ReportsEveryStrategyOfAChain) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.exr"})).exit_code, 0);
    const nlohmann::json statistics = json("a.json")["statistics"];
    ASSERT_GE(statistics["strategies"].size(), 3u);
    std::uint64_t proposals = 0;
    for (const nlohmann::json& s : statistics["strategies"]) {
        EXPECT_GT(s["proposals"], 0) << s;
        EXPECT_LE(s["accepted"], s["proposals"]) << s;
        EXPECT_GE(s["mean_acceptance"], 0) << s;
        EXPECT_LE(s["mean_acceptance"], 1) << s;
        EXPECT_TRUE(s["failures"].is_object());
        proposals += s["proposals"].get<std::uint64_t>();
    }
    EXPECT_EQ(proposals, statistics["mutations"]);
    EXPECT_GT(statistics["b_standard_error"], 0);
}

TEST_F(RenderCommand, NamesTheImageAfterTheScene) {
    Finished done = run(quick_render("room.xml"));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("wrote room.exr"));
    std::filesystem::create_directory(path("blue hall"));
    write("blue hall/scene_v3.xml", room_scene);
    done = run(quick_render("blue hall/scene_v3.xml"));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(files(),
                ElementsAre("blue hall", "blue hall.exr", "blue hall.json", "room.exr", "room.json", "room.xml"));
}

TEST_F(RenderCommand, PngAloneWritesNoExr) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.PNG", "--exposure", "1"})).exit_code, 0);
    EXPECT_THAT(files(), ElementsAre("a.PNG", "a.json", "room.xml"));
}

TEST_F(RenderCommand, ExposureBrightensThePngOnly) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.png", "-D", "light=0.1"})).exit_code, 0);
    ASSERT_EQ(
        run(quick_render("room.xml", {"-o", "b.png", "-o", "b.exr", "-D", "light=0.1", "--exposure", "2"})).exit_code,
        0);
    EXPECT_GT(mean(image("b.png")), 1.5 * mean(image("a.png")));
    EXPECT_LT(mean(image("b.exr")), 1.5 * mean(image("a.png")));
}

TEST_F(RenderCommand, SameSeedSameBitsWithAnyNumberOfThreads) {
    for (const std::string integrator : {"mmlt", "path"}) {
        const auto render = [&](const std::string& name, const std::string& threads, const std::string& seed) {
            EXPECT_EQ(run(quick_render("room.xml",
                                       {"--integrator", integrator, "-o", name, "--threads", threads, "--seed", seed}))
                          .exit_code,
                      0);
            return image(name).rgb;
        };
        const std::vector<float> one = render("one.exr", "1", "7");
        EXPECT_EQ(render("two.exr", "2", "7"), one) << integrator;
        EXPECT_EQ(render("seven.exr", "7", "7"), one) << integrator;
        EXPECT_NE(render("other.exr", "2", "8"), one) << integrator;
        // All that may differ in the reports is time, memory and the number of threads.
        nlohmann::json a = json("one.json"), b = json("two.json");
        for (nlohmann::json* report : {&a, &b}) {
            for (const char* key : {"started", "finished"}) report->erase(key);
            (*report)["settings"].erase("threads");
            for (const char* key : {"seconds_reading", "seconds_building"}) (*report)["scene"].erase(key);
            for (const char* key : {"mutations_per_second", "rays_per_second", "seconds_bootstrap", "seconds_render",
                                    "cpu_seconds", "threads", "peak_memory_bytes", "tuning"})
                (*report)["statistics"].erase(key);
        }
        EXPECT_EQ(a, b);
    }
}

TEST_F(RenderCommand, SizeAndCropChooseThePixels) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.exr", "--size", "40x24", "--crop", "8,4,10,6"})).exit_code, 0);
    EXPECT_EQ(image("a.exr").width, 10);
    EXPECT_EQ(image("a.exr").height, 6);
    EXPECT_EQ(json("a.json")["film"]["width"], 40);
    EXPECT_EQ(json("a.json")["film"]["crop"], (std::vector<int>{8, 4, 10, 6}));
}

TEST_F(RenderCommand, DefinesChangeTheScene) {
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "a.exr", "-D", "light=5"})).exit_code, 0);
    ASSERT_EQ(run(quick_render("room.xml", {"-o", "b.exr", "-Dlight=20"})).exit_code, 0);
    // The same random numbers and a light four times as strong; floats round.
    EXPECT_NEAR(mean(image("b.exr")) / mean(image("a.exr")), 4, 1e-3);
    EXPECT_EQ(json("b.json")["scene"]["defines"]["light"], "20");
}

// Without --mix, one is found, and written to a file that makes the same image again.
TEST_F(RenderCommand, FindsAMixAndWritesIt) {
    const Finished done = run({"render", "room.xml", "-o", "a.exr", "-n", "200", "--bootstrap", "4096", "-v"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, AllOf(HasSubstr("mix: "), HasSubstr("that raced for"), HasSubstr("wrote a.mix.toml")));
    const nlohmann::json report = json("a.json");
    const nlohmann::json& tuning = report["statistics"]["tuning"];
    EXPECT_GE(tuning["contenders"].size(), 2u);
    EXPECT_GT(tuning["contenders"][0]["error"], 0);
    EXPECT_THAT(report["settings"]["mix"].get<std::string>(), HasSubstr("tuning = \"off\""));
    ASSERT_EQ(run({"render", "room.xml", "-o", "b.exr", "-n", "200", "--mix", "a.mix.toml"}).exit_code, 0);
    EXPECT_EQ(image("a.exr").rgb, image("b.exr").rgb);
    ASSERT_EQ(run({"render", "--like", "a.exr", "-o", "c.exr"}).exit_code, 0);
    EXPECT_EQ(image("a.exr").rgb, image("c.exr").rgb);
}

TEST_F(RenderCommand, TimedRunEndsInTime) {
    const Finished done = run({"render", "room.xml", "-o", "a.exr", "--time", "300ms", "--bootstrap", "4096"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json statistics = json("a.json")["statistics"];
    EXPECT_GT(statistics["mutations"], 0);
    const double seconds = statistics["seconds_bootstrap"].get<double>() + statistics["seconds_render"].get<double>();
    EXPECT_GT(seconds, 0.25);
    EXPECT_LT(seconds, 30);  // a busy machine
}

TEST_F(RenderCommand, QuietSaysNothingAndVerboseMore) {
    const Finished quiet = run(quick_render("room.xml", {"-o", "a.exr", "--quiet"}));
    EXPECT_EQ(quiet.exit_code, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    const Finished normal = run(quick_render("room.xml", {"-o", "a.exr"}));
    EXPECT_THAT(normal.err, AllOf(HasSubstr("render"), HasSubstr("elapsed"), Not(HasSubstr("\r"))));
    EXPECT_THAT(normal.out, AllOf(HasSubstr("mean luminance"), HasSubstr("standard error"), HasSubstr("% accepted")));
    const Finished verbose = run(quick_render("room.xml", {"-o", "a.exr", "-v"}));
    EXPECT_THAT(verbose.err, HasSubstr("triangles"));
    EXPECT_THAT(verbose.out, AllOf(HasSubstr("proposals"), HasSubstr("peak memory")));
}

TEST_F(RenderCommand, RedrawsOneLineOnATerminal) {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_TRUE(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
    const std::string name = ptsname(terminal);
    Process process(folder(), quick_render("room.xml", {"-o", "a.exr"}), [&] {
        setenv("TERM", "xterm", 1);
        dup2(open(name.c_str(), O_RDWR | O_NOCTTY), STDERR_FILENO);
    });
    EXPECT_EQ(process.wait().exit_code, 0);
    std::string text(4096, '\0');
    const ssize_t count = read(terminal, text.data(), text.size());
    close(terminal);
    ASSERT_GT(count, 0);
    text.resize(static_cast<std::size_t>(count));
    EXPECT_THAT(text, AllOf(HasSubstr("["), HasSubstr("\r\033[K"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace keyhole
