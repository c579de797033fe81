// `keyhole diff`
#include <gmock/gmock.h>

#include <cmath>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class DiffCommand : public CommandTest {
  protected:
    // Values c and c (1 +- 0.125): exact in floats, and the metrics have closed forms.
    DiffCommand() {
        Image reference(40, 30), image(40, 30);
        for (std::size_t i = 0; i < image.rgb.size(); ++i) {
            reference.rgb[i] = 2;
            image.rgb[i] = i % 2 ? 2.25f : 1.75f;
        }
        save("ref.exr", reference);
        save("a.exr", image);
    }
    void save(const std::string& name, const Image& image) const { write_image(path(name).string(), image); }
    Image load(const std::string& name) const { return read_image(path(name).string()); }
};

TEST_F(DiffCommand, JsonHoldsValuesAndFormulas) {
    const Finished done = run({"diff", "a.exr", "ref.exr", "--json"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json json = nlohmann::json::parse(done.out);
    const auto value = [&](const char* name) { return json["metrics"][name]["value"].get<double>(); };
    EXPECT_NEAR(value("mse"), 0.0625, 1e-12);
    EXPECT_NEAR(value("rmse"), 0.25, 1e-12);
    EXPECT_NEAR(value("rrmse"), 0.125 / std::sqrt(1.001), 1e-12);
    EXPECT_NEAR(value("relmse_trimmed"), 0.015625 / 1.001, 1e-12);
    EXPECT_NEAR(value("mape"), 0.125 / std::sqrt(1.001), 1e-12);
    EXPECT_NEAR(value("mean_ratio"), 1, 1e-12);
    EXPECT_EQ(json["metrics"]["rrmse"]["formula"], "sqrt(mean((I-R)^2 / (R^2 + 0.001 mean(R)^2)))");
    EXPECT_EQ(json["pixels"], 1200);
    EXPECT_EQ(json["mean_ratio_rgb"].size(), 3u);
}

TEST_F(DiffCommand, TableStatesTheFormulas) {
    const Finished done = run({"diff", "a.exr", "ref.exr"});
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_THAT(done.out, HasSubstr("1200 compared, 0 masked, 0 not finite"));
    for (const char* text :
         {"mse ", "rmse ", "rrmse ", "relmse_trimmed ", "mape ", "smape ", "mean_ratio ", "R^2 + 0.001 mean(R)^2"})
        EXPECT_THAT(done.out, HasSubstr(text));
}

TEST_F(DiffCommand, MetricPrintsNumbersAlone) {
    const Finished done = run({"diff", "a.exr", "ref.exr", "--metric", "rmse", "--metric", "mse"});
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_EQ(done.out, "0.25\n0.0625\n");
}

TEST_F(DiffCommand, MaskLeavesPixelsOut) {
    Image mask(40, 30), spoiled = load("a.exr");
    std::fill(mask.rgb.begin(), mask.rgb.end(), 1.0f);
    std::fill_n(mask.pixel(3, 4), 3, 0.0f);
    std::fill_n(spoiled.pixel(3, 4), 3, 1000.0f);
    save("mask.png", mask);
    save("spoiled.exr", spoiled);
    const auto rmse = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"diff", "spoiled.exr", "ref.exr", "--metric", "rmse"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return std::stod(run(arguments).out);
    };
    EXPECT_GT(rmse({}), 20);
    EXPECT_NEAR(rmse({"--mask", "mask.png"}), 0.25, 1e-9);
}

TEST_F(DiffCommand, ErrorImageShowsWhereTheErrorIs) {
    Image image = load("ref.exr");
    std::fill_n(image.pixel(7, 2), 3, 4.0f);
    save("b.exr", image);
    const Finished done = run({"diff", "b.exr", "ref.exr", "--error-image", "error.png", "--error-maximum", "0.5"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("wrote error.png"));
    EXPECT_THAT(done.out, HasSubstr("pale yellow 0.5"));
    const Image error = load("error.png");
    ASSERT_EQ(error.width, 40);
    EXPECT_GT(error.pixel(7, 2)[0], 0.9f);
    EXPECT_LT(error.pixel(8, 2)[0], 0.01f);
    EXPECT_EQ(run({"diff", "b.exr", "ref.exr", "--error-image", "error.exr"}).exit_code, 0);
    EXPECT_EQ(load("error.exr").height, 30);
}

TEST_F(DiffCommand, WarnsAboutValuesThatAreNotFinite) {
    Image image = load("a.exr");
    image.pixel(1, 1)[1] = std::nanf("");
    save("b.exr", image);
    const Finished done = run({"diff", "b.exr", "ref.exr", "--json"});
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_THAT(done.err, HasSubstr("warning: 1 pixels with values that are not finite"));
    EXPECT_EQ(nlohmann::json::parse(done.out)["non_finite"], 1);
}

TEST_F(DiffCommand, BadInputEndsWithCode2AndNoErrorImage) {
    save("small.exr", Image(4, 4));
    write("broken.exr", "no image");
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"small.exr", "ref.exr"}, "the image is 4x4 pixels and the reference is 40x30; they must be equal"},
        {{"a.exr", "ref.exr", "--mask", "small.exr"}, "the mask is 4x4 pixels"},
        {{"a.exr", "missing.exr"}, "missing.exr: cannot read the image"},
        {{"broken.exr", "ref.exr"}, "broken.exr: cannot read the image"},
        {{"a.exr", "ref.exr", "--error-image", "error.tif"}, "valid extensions: .exr"},
    };
    for (const auto& [files_given, message] : cases) {
        std::vector<std::string> arguments = {"diff"};
        arguments.insert(arguments.end(), files_given.begin(), files_given.end());
        if (files_given.size() == 2) arguments.insert(arguments.end(), {"--error-image", "error.png"});
        const Finished done = run(arguments);
        EXPECT_EQ(done.exit_code, 2) << message;
        EXPECT_THAT(done.err, HasSubstr(message));
        EXPECT_THAT(files(), ElementsAre("a.exr", "broken.exr", "ref.exr", "small.exr"));
    }
    EXPECT_EQ(run({"diff", "a.exr", "ref.exr", "--error-image", "none/error.png"}).exit_code, 1);
}

}  // namespace
}  // namespace keyhole
