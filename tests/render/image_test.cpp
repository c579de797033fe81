#include "render/image.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ImageTest : public testing::Test {
  protected:
    ImageTest() {
        std::string pattern = (fs::temp_directory_path() / "keyhole-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~ImageTest() override { fs::remove_all(folder_); }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    void expect_only(const std::string& name) const {
        for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_EQ(entry.path().filename(), name);
    }

    fs::path folder_;
};

Image ramp(int width, int height) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = 1e-3f * static_cast<float>(i * i) - 0.01f;
    return image;
}

OIIO::ImageSpec spec_of(const std::string& filename) {
    const auto input = OIIO::ImageInput::open(filename);
    return input ? input->spec() : OIIO::ImageSpec();
}

TEST_F(ImageTest, ExrKeepsEveryBitOfAFloat) {
    Image image = ramp(5, 3);
    image.rgb[7] = 12345678.0f;
    image.rgb[8] = std::numeric_limits<float>::denorm_min();
    write_image(file("a.exr"), image);
    const Image back = read_image(file("a.exr"));
    EXPECT_EQ(back.width, 5);
    EXPECT_EQ(back.height, 3);
    EXPECT_EQ(back.rgb, image.rgb);
    const OIIO::ImageSpec spec = spec_of(file("a.exr"));
    EXPECT_EQ(spec.format, OIIO::TypeFloat);
    EXPECT_EQ(spec.channelnames, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    expect_only("a.exr");
}

TEST_F(ImageTest, MetadataIsStoredInBothFormats) {
    WriteOptions options;
    options.metadata = {{"keyhole:seed", "42"}, {"keyhole:run", std::string(5000, 'x') + "{\"a\": \"b\"}"}};
    for (const std::string name : {"a.exr", "a.png"}) {
        write_image(file(name), ramp(4, 4), options);
        const OIIO::ImageSpec spec = spec_of(file(name));
        EXPECT_EQ(spec.get_string_attribute("keyhole:seed"), "42") << name;
        EXPECT_EQ(spec.get_string_attribute("keyhole:run"), options.metadata["keyhole:run"]) << name;
    }
}

TEST_F(ImageTest, PngIsSrgbWithExposureAndClipping) {
    Image image(6, 1);
    const float values[6] = {0.0f, 0.0625f, 0.25f, 1.0f, -3.0f, std::nanf("")};
    for (int x = 0; x < 6; ++x) std::fill_n(image.pixel(x, 0), 3, values[x]);
    WriteOptions brighter;
    brighter.exposure = 1;
    write_image(file("a.png"), image, brighter);

    const auto input = OIIO::ImageInput::open(file("a.png"));
    ASSERT_TRUE(input);
    EXPECT_EQ(input->spec().format, OIIO::TypeUInt8);
    std::vector<unsigned char> bytes(18);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, bytes.data()));
    // sRGB of 0, 1/8, 1/2, clipped, negative, not a number: 255 * (1.055 v^(1/2.4) - 0.055) = 99.1, 187.5 (-> 188).
    EXPECT_THAT(bytes, testing::ElementsAre(0, 0, 0, 99, 99, 99, 188, 188, 188, 255, 255, 255, 0, 0, 0, 0, 0, 0));
}

TEST_F(ImageTest, PngReadsBackAsLinearWithinHalfAStep) {
    Image image(256, 1);
    for (int x = 0; x < 256; ++x) std::fill_n(image.pixel(x, 0), 3, static_cast<float>(x) / 255);
    write_image(file("a.png"), image);
    const Image back = read_image(file("a.png"));
    // Half of one of 255 encoded steps, times the largest slope of the decoding, 2.4 / 1.055.
    for (std::size_t i = 0; i < image.rgb.size(); ++i) EXPECT_NEAR(back.rgb[i], image.rgb[i], 0.5 / 255 * 2.28);
}

TEST_F(ImageTest, GreyAndAlphaImagesAreRead) {
    OIIO::ImageSpec grey(2, 1, 1, OIIO::TypeFloat);
    const float values[2] = {0.5f, 2.0f};
    auto output = OIIO::ImageOutput::create(file("grey.exr"));
    ASSERT_TRUE(output && output->open(file("grey.exr"), grey) && output->write_image(OIIO::TypeFloat, values));
    output->close();
    EXPECT_EQ(read_image(file("grey.exr")).rgb, (std::vector<float>{0.5f, 0.5f, 0.5f, 2.0f, 2.0f, 2.0f}));

    OIIO::ImageSpec named(1, 1, 4, OIIO::TypeFloat);
    named.channelnames = {"A", "B", "G", "R"};
    const float abgr[4] = {1, 2, 3, 4};
    output = OIIO::ImageOutput::create(file("named.exr"));
    ASSERT_TRUE(output && output->open(file("named.exr"), named) && output->write_image(OIIO::TypeFloat, abgr));
    output->close();
    EXPECT_EQ(read_image(file("named.exr")).rgb, (std::vector<float>{4, 3, 2}));
}

TEST_F(ImageTest, ReadingErrorsNameTheFile) {
    std::ofstream(file("broken.exr")) << "no image at all";
    for (const std::string name : {"missing.exr", "broken.exr"}) {
        try {
            read_image(file(name));
            ADD_FAILURE() << "read " << name;
        } catch (const InputError& e) {
            EXPECT_EQ(e.where().file, file(name));
            EXPECT_THAT(e.what(), HasSubstr("cannot read the image"));
        }
    }
}

TEST_F(ImageTest, UnknownExtensionListsTheValidOnes) {
    for (const std::string name : {"a.jpg", "a"}) {
        try {
            write_image(file(name), ramp(1, 1));
            ADD_FAILURE() << "wrote " << name;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr("valid extensions: .exr (32-bit float, linear), .png (8-bit sRGB)"));
        }
    }
    EXPECT_TRUE(fs::is_empty(folder_));
    EXPECT_EQ(image_format("A.EXR"), "openexr");
    EXPECT_EQ(image_format("a.b.PnG"), "png");
}

TEST_F(ImageTest, FailedWritingLeavesNothing) {
    std::ofstream(file("plain")) << "x";
    for (const std::string name : {"plain/a.exr", "none/a.exr", "none/a.png"})
        EXPECT_THROW(write_image(file(name), ramp(2, 2)), std::runtime_error) << name;
    fs::create_directory(file("a.exr"));
    EXPECT_THROW(write_image(file("a.exr"), ramp(2, 2)), std::runtime_error);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

// A limit on the size of files stands in for a full disk: both make the write itself fail.
TEST_F(ImageTest, FullDiskIsReportedAndTheEarlierImageStays) {
    Image noise(64, 64);
    for (std::size_t i = 0; i < noise.rgb.size(); ++i) noise.rgb[i] = std::fabs(std::sin(static_cast<float>(i * i)));
    for (const std::string name : {"a.exr", "a.png"}) {
        write_image(file(name), ramp(2, 2));
        const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
        rlimit unlimited{};
        getrlimit(RLIMIT_FSIZE, &unlimited);
        const rlimit small{4096, unlimited.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        EXPECT_THROW(write_image(file(name), noise), std::runtime_error) << name;
        setrlimit(RLIMIT_FSIZE, &unlimited);
        std::signal(SIGXFSZ, old_handler);
        EXPECT_EQ(read_image(file(name)).width, 2) << name;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

}  // namespace
}  // namespace keyhole
