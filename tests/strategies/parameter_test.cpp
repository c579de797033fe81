// Values of parameters: from text, checked, and as TOML.
#include "strategies/parameter.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace keyhole {
namespace {

std::string refusal(const Parameter& p, const std::string& text) {
    try {
        value_from_text(p, text);
    } catch (const InputError& e) {
        return e.what();
    }
    return "it was taken";
}

TEST(Parameter, OfABooleanIsTrueOrFalse) {
    Parameter p = Parameter::text("flag", "");
    p.type = Parameter::Type::boolean;
    EXPECT_EQ(value_from_text(p, "true"), Value(true));
    EXPECT_EQ(value_from_text(p, "false"), Value(false));
    EXPECT_EQ(refusal(p, "yes"), "'flag' cannot be \"yes\"; valid: true or false");
    EXPECT_EQ(to_toml(p, true), "true");
    EXPECT_THROW(checked(p, std::int64_t{1}), InputError);
}

TEST(Parameter, OfANumberTakesIntegersAndItsBounds) {
    const Parameter p = Parameter::number("x", 1, 0, 2, "").open().in("edges");
    EXPECT_EQ(value_from_text(p, "2"), Value(2.0));
    EXPECT_EQ(checked(p, std::int64_t{1}), Value(1.0));
    EXPECT_EQ(value_from_text(p, "1e-300"), Value(1e-300));
    for (const char* text : {"0", "-1", "2.0000001", "inf", "nan", "", "1x"})
        EXPECT_EQ(refusal(p, text),
                  "'" + std::string(text) + "' is not valid here; valid: a number above 0 to 2 edges");
    EXPECT_EQ(to_toml(p, 2.0), "2.0");
    EXPECT_EQ(to_toml(p, 0.1), "0.1");
    EXPECT_EQ(to_toml(p, 1e-300), "1e-300");
}

TEST(Parameter, OfAnIntegerMayHaveAWord) {
    const Parameter p = Parameter::integer("n", 0, 1, 9, "").or_word("auto");
    EXPECT_EQ(value_from_text(p, "auto"), Value(std::int64_t{0}));
    EXPECT_EQ(value_from_text(p, "9"), Value(std::int64_t{9}));
    EXPECT_EQ(to_toml(p, std::int64_t{0}), "\"auto\"");
    for (const char* text : {"0", "10", "1.5", "scene", "99999999999999999999"})
        EXPECT_EQ(refusal(p, text),
                  "'" + std::string(text) + "' is not valid here; valid: an integer from 1 to 9 or \"auto\"");
}

TEST(Parameter, HasAnEffectOnlyWithWhatItNeeds) {
    const Parameter p = Parameter::number("sigma", 1, 0, 2, "").only_with("kernel", "gaussian");
    EXPECT_TRUE(has_effect(p, {{"kernel", "gaussian"}}));
    EXPECT_FALSE(has_effect(p, {{"kernel", "kelemen"}}));
}

TEST(Parameter, TextIsQuoted) {
    const Parameter p = Parameter::text("name", "");
    EXPECT_EQ(to_toml(p, "a \"b\" \\ \n\x7f"), "\"a \\\"b\\\" \\\\ \\u000a\\u007f\"");
}

}  // namespace
}  // namespace keyhole
