#include "compare/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "compare/report_template.h"

namespace keyhole {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string decode_base64(const std::string& text) {
    const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned buffer = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        buffer = buffer << 6 | static_cast<unsigned>(alphabet.find(c));
        if ((bits += 6) >= 8) bytes += static_cast<char>(buffer >> (bits -= 8) & 0xff);
    }
    return bytes;
}

// The layout as report.cpp documents it, read the other way round.
Image decode(const EncodedImage& encoded, int width, int height) {
    const std::string compressed = decode_base64(encoded.base64);
    Image image(width, height);
    const std::size_t count = image.rgb.size(), pixels = count / 3;
    std::string bytes(2 * count, '\0');
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                         reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
              Z_OK);
    EXPECT_EQ(size, 2 * count);
    std::uint16_t bits = 0;
    for (std::size_t i = 0; i < count; ++i) {
        bits = static_cast<std::uint16_t>(bits + (static_cast<unsigned char>(bytes[i]) << 8) +
                                          static_cast<unsigned char>(bytes[count + i]));
        const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
        const double magnitude = exponent == 31 ? (mantissa ? NAN : INFINITY)
                                 : exponent     ? std::ldexp(1024 + mantissa, exponent - 25)
                                                : std::ldexp(mantissa, -24);
        image.rgb[i % pixels * 3 + i / pixels] =
            static_cast<float>((bits & 0x8000 ? -magnitude : magnitude) * encoded.scale);
    }
    return image;
}

std::string written_page(const nlohmann::json& results, const std::vector<ReportImage>& images) {
    const std::string file = testing::TempDir() + "report_" + std::to_string(getpid()) + ".html";
    write_report(file, results, images);
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    std::filesystem::remove(file);
    return text.str();
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from) + from.size();
    return text.substr(begin, text.find(to, begin) - begin);
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
}

TEST(Report, ImagesComeBackToHalfPrecision) {
    Image image(37, 5);
    std::uint32_t state = 1;
    for (float& v : image.rgb) {
        state = state * 1664525u + 1013904223u;
        v = std::exp(static_cast<float>(state >> 8) / 16777216.0f * 18 - 8);  // 3e-4 to 2e4
    }
    const EncodedImage encoded = encode_image(image);
    EXPECT_EQ(encoded.scale, 1);
    const Image back = decode(encoded, image.width, image.height);
    // Half of the last of 11 bits, relative to the value.
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        EXPECT_NEAR(back.rgb[i], image.rgb[i], image.rgb[i] * std::ldexp(1, -11)) << i;
}

TEST(Report, ValuesBeyondAHalfAreScaledByAPowerOfTwo) {
    Image image(2, 1);
    image.rgb = {65504, 65505, 0.5f, 3e6f, -4, 0};
    const EncodedImage encoded = encode_image(image);
    EXPECT_EQ(encoded.scale, 64);  // 3e6 / 65504 = 45.8
    const Image back = decode(encoded, 2, 1);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(back.rgb[i], image.rgb[i], std::abs(image.rgb[i]) * std::ldexp(1, -11)) << i;
    image.rgb = {65504, 0, 0, 0, 0, 0};
    EXPECT_EQ(encode_image(image).scale, 1);
}

TEST(Report, WhatIsNotFiniteStaysSo) {
    Image image(1, 1);
    image.rgb = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                 std::numeric_limits<float>::quiet_NaN()};
    const EncodedImage encoded = encode_image(image);
    EXPECT_EQ(encoded.scale, 1);
    const Image back = decode(encoded, 1, 1);
    EXPECT_EQ(back.rgb[0], image.rgb[0]);
    EXPECT_EQ(back.rgb[1], image.rgb[1]);
    EXPECT_TRUE(std::isnan(back.rgb[2]));
}

TEST(Report, TextCannotEndTheDataOrBecomeMarkup) {
    const std::string name = "</script><!--<script>\"'&\\ λ \xe2\x80\xa8 end";
    const nlohmann::json results = {{"entries", {{{"name", name}}}}};
    const std::string page = written_page(results, {{name, Image(1, 1)}});
    const std::string data = between(page, "<script type=\"application/json\" id=\"data\">", "</script>");
    EXPECT_THAT(data, Not(HasSubstr("<")));
    const nlohmann::json back = nlohmann::json::parse(data);
    EXPECT_EQ(back["results"], results);
    EXPECT_EQ(back["images"][0]["name"], name);
}

TEST(Report, TextThatIsNotUtf8IsMended) {
    const std::string page = written_page({{"command",
                                            "a\xff"
                                            "b"}},
                                          {});
    EXPECT_THAT(page, HasSubstr("a\xef\xbf\xbd"
                                "b"));
}

TEST(Report, IsOnePageWithItsImagesAndNothingFromOutside) {
    const Image image(3, 2);
    const std::string page = written_page(nlohmann::json::object(), {{"reference", image}, {"a", image}});
    EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
    EXPECT_EQ(count(page, "<script"), 4u);  // data, two images, the program
    EXPECT_EQ(count(page, "</script>"), 4u);
    EXPECT_EQ(count(page, "</html>"), 1u);
    EXPECT_EQ(count(page, std::string(report_data_mark)), 0u);
    const std::string encoded = between(page, "id=\"image-1\">", "</script>");
    EXPECT_EQ(encoded, encode_image(image).base64);
    EXPECT_THAT(page, Not(HasSubstr("src=")));
    EXPECT_THAT(page, Not(HasSubstr("@import")));
    EXPECT_THAT(page, Not(HasSubstr("<link rel=\"stylesheet")));
}

TEST(Report, CarriesTheColourMapOfTheErrorImages) {
    const std::string page = written_page(nlohmann::json::object(), {});
    const nlohmann::json map = nlohmann::json::parse(
        between(page, "<script type=\"application/json\" id=\"data\">", "</script>"))["colour_map"];
    ASSERT_EQ(map.size(), 256u);
    // The ends of magma: #000004 and #fcfdbf, in steps of 8 bits.
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(map[0][c].get<int>(), (std::array{0, 0, 4})[c], 1);
        EXPECT_NEAR(map[255][c].get<int>(), (std::array{252, 253, 191})[c], 1);
    }
}

TEST(Report, TheTemplateIsSmallAndHasOnePlaceForTheData) {
    EXPECT_LT(report_template.size(), 200u * 1024);
    EXPECT_EQ(count(std::string(report_template), std::string(report_data_mark)), 1u);
}

TEST(Report, ImagesOfDifferentOrNoSizeAreAnError) {
    EXPECT_THROW(written_page({}, {{"a", Image(3, 2)}, {"b", Image(2, 3)}}), InputError);
    EXPECT_THROW(written_page({}, {{"a", Image(0, 0)}}), InputError);
}

}  // namespace
}  // namespace keyhole
