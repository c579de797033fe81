#include "base/units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

template <class Parse>
std::string refusal(const Parse& parse) {
    try {
        parse();
    } catch (const InputError& e) {
        return e.what();
    }
    return "accepted";
}

TEST(Units, Durations) {
    EXPECT_DOUBLE_EQ(parse_duration("60"), 60);
    EXPECT_DOUBLE_EQ(parse_duration("60s"), 60);
    EXPECT_DOUBLE_EQ(parse_duration("0.5s"), 0.5);
    EXPECT_DOUBLE_EQ(parse_duration("500ms"), 0.5);
    EXPECT_DOUBLE_EQ(parse_duration("10m"), 600);
    EXPECT_DOUBLE_EQ(parse_duration("1h30m"), 5400);
    EXPECT_DOUBLE_EQ(parse_duration("1.5h"), 5400);
    EXPECT_DOUBLE_EQ(parse_duration("2d1h1m1s1ms"), 2 * 86400 + 3661.001);
    for (const char* text : {"", "s", "60x", "30m1h", "1h1h", "-5s", "5 s", "1e999", "nan", "inf", "10m5"})
        EXPECT_THAT(refusal([&] { parse_duration(text); }), HasSubstr("is not a duration; valid: ")) << text;
}

TEST(Units, SizesAndCrops) {
    EXPECT_EQ(parse_size("640x480"), (std::array<int, 2>{640, 480}));
    for (const char* text : {"", "640", "640x", "x480", "640X480", "0x480", "640x-1", "640x480x3", "70000x1", "1.5x2"})
        EXPECT_THAT(refusal([&] { parse_size(text); }), HasSubstr("is not a size; valid: WIDTHxHEIGHT")) << text;
    EXPECT_EQ(parse_crop("0,5,64,32"), (std::array<int, 4>{0, 5, 64, 32}));
    for (const char* text : {"", "1,2,3", "1,2,3,0", "-1,2,3,4", "1,2,3,4,5", "1 2 3 4"})
        EXPECT_THAT(refusal([&] { parse_crop(text); }), HasSubstr("is not a crop window; valid: X,Y,WIDTH")) << text;
}

TEST(Units, Numbers) {
    EXPECT_EQ(parse_real("0.25", 0, 1), 0.25);
    EXPECT_EQ(parse_real("0", 0, 1), 0);
    EXPECT_EQ(refusal([] { parse_real("2", 0, 1); }), "'2' is not valid here; valid: a number from 0 to 1");
    EXPECT_EQ(refusal([] { parse_real("0", 0, 1, true); }), "'0' is not valid here; valid: a number above 0 to 1");
    for (const char* text : {"", "nan", "inf", "0.5x", " 0.5"})
        EXPECT_NE(refusal([&] { parse_real(text, 0, 1); }), "accepted") << text;
    EXPECT_EQ(parse_integer("-3", -5, 5), -3);
    EXPECT_EQ(refusal([] { parse_integer("6", -5, 5); }), "'6' is not valid here; valid: an integer from -5 to 5");
    EXPECT_NE(refusal([] { parse_integer("1.0", 0, 5); }), "accepted");
    EXPECT_EQ(parse_unsigned("18446744073709551615"), 18446744073709551615u);
    for (const char* text : {"-1", "18446744073709551616", "1.5", ""})
        EXPECT_THAT(refusal([&] { parse_unsigned(text); }), HasSubstr("an integer from 0 to 18446744073709551615"));
}

TEST(Units, FormattedDurations) {
    EXPECT_EQ(format_duration(0.0421), "42ms");
    EXPECT_EQ(format_duration(0.9996), "1.0s");
    EXPECT_EQ(format_duration(4.24), "4.2s");
    EXPECT_EQ(format_duration(9.96), "10s");
    EXPECT_EQ(format_duration(59.6), "1m00s");
    EXPECT_EQ(format_duration(245), "4m05s");
    EXPECT_EQ(format_duration(3720), "1h02m");
    EXPECT_EQ(format_duration(86400 * 3 + 4 * 3600), "3d04h");
}

TEST(Units, FormattedCounts) {
    EXPECT_EQ(format_count(7), "7");
    EXPECT_EQ(format_count(999.4), "999");
    EXPECT_EQ(format_count(999.6), "1.00 k");
    EXPECT_EQ(format_count(12000), "12.0 k");
    EXPECT_EQ(format_count(1.552e6), "1.55 M");
    EXPECT_EQ(format_count(4e15), "4000 T");
    EXPECT_EQ(format_bytes(512), "512 B");
    EXPECT_EQ(format_bytes(std::uint64_t{3} << 29), "1.50 GiB");
}

}  // namespace
}  // namespace keyhole
