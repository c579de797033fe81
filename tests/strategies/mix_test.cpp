// Mixes as values, and their way through text and back.
#include "strategies/mix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/rng.h"
#include "own_scenes.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

TEST(BuiltinMixes, AreTheFilesOfMixesInCanonicalForm) {
    ASSERT_FALSE(builtin_mixes().empty());
    for (const Mix& mix : builtin_mixes()) {
        std::ifstream file(std::string(KEYHOLE_SOURCE_DIR) + "/mixes/" + mix.name + ".toml");
        std::ostringstream text;
        ASSERT_TRUE(text << file.rdbuf()) << mix.name;
        EXPECT_EQ(write_mix(mix), text.str());
        EXPECT_NE(mix.description, "");
    }
    EXPECT_THAT(error_of([] { builtin_mix("mmmlt"); }),
                HasSubstr("unknown mix 'mmmlt'; did you mean 'mmlt'? valid names: "));
}

TEST(BuiltinMixes, ThatWalkOnMoveAsThoseThatDoNot) {
    for (const std::string name : {"mmlt", "rjmlt", "fused", "fused-geo", "fused-portal", "fused-all"})
        EXPECT_EQ(builtin_mix(name + "-walk-on").strategies, builtin_mix(name).strategies) << name;
}

TEST(BuiltinMixes, MmltIsThePublishedMethodWithItsDefaults) {
    const Mix& mix = builtin_mix("mmlt");
    EXPECT_EQ(mix.target, TargetFunction::luminance);
    EXPECT_FALSE(mix.lengths.fixed);
    ASSERT_EQ(mix.strategies.size(), 3u);
    EXPECT_EQ(mix.strategies[0].info->name, "large-step");
    EXPECT_EQ(mix.strategies[0].weight, 0.1);
    EXPECT_EQ(mix.strategies[1].info->name, "small-step");
    EXPECT_EQ(mix.strategies[1].parameters.at("kernel"), Value("kelemen"));
    EXPECT_EQ(mix.strategies[1].parameters.at("s1"), Value(1.0 / 1024));
    EXPECT_EQ(mix.strategies[1].parameters.at("s2"), Value(1.0 / 64));
    EXPECT_EQ(mix.strategies[2].info->name, "technique-change");
    EXPECT_EQ(mix.strategies[2].weight, 0.05);
}

TEST(MixFile, SaysAllThatAMixCanSay) {
    const Mix mix = parse_mix(R"(description = "with \"quotes\""
target = "max-channel"
seed = 9223372036854775807
[lengths]
min = 2
max = 7
per-chain = "fixed"
[chains]
count = 12
length = 1000
[bootstrap]
samples = 5000
[[strategy]]
type = "small-step"
weight = 3
[[strategy]]
type = "small-step"
weight = 1e-3
kernel = "gaussian"
sigma = 0.25
[[strategy]]
type = "large-step"
label = "afresh"
weight = 0.5
)",
                              "some/where/odd.toml");
    EXPECT_EQ(mix.name, "odd");
    EXPECT_EQ(mix.description, "with \"quotes\"");
    EXPECT_EQ(mix.target, TargetFunction::max_channel);
    EXPECT_EQ(mix.rectification, RectificationSettings{});
    EXPECT_EQ(mix.seed, 9223372036854775807u);
    EXPECT_EQ(mix.lengths, (PathLengths{2, 7, true}));
    EXPECT_EQ(mix.chain_count, 12);
    EXPECT_EQ(mix.chain_length, 1000);
    EXPECT_EQ(mix.bootstrap_samples, 5000);
    ASSERT_EQ(mix.strategies.size(), 3u);
    EXPECT_EQ(mix.strategies[0].label, "small-step");
    EXPECT_EQ(mix.strategies[1].label, "small-step-2");
    EXPECT_EQ(mix.strategies[1].parameters.at("sigma"), Value(0.25));
    EXPECT_EQ(mix.strategies[2].label, "afresh");
    EXPECT_EQ(parse_mix(write_mix(mix), "other.toml"), mix);
}

// A mix with random values in every key that has an effect.
Mix random_mix(Rng& rng) {
    Mix mix = builtin_mix("mmlt");
    const auto random_value = [&](const Parameter& p) -> Value {
        switch (p.type) {
            case Parameter::Type::number:
                return p.min + (std::min(p.max, 10.0) - p.min) * (1 - rng.uniform());
            case Parameter::Type::integer:
                return static_cast<std::int64_t>(p.min + (std::min(p.max, 0x1p62) - p.min) * rng.uniform());
            case Parameter::Type::boolean:
                return rng.below(2) == 1;
            case Parameter::Type::choice:
                return p.choices[rng.below(static_cast<std::uint32_t>(p.choices.size()))];
            case Parameter::Type::text:
                break;
        }
        std::string text;
        for (std::uint32_t i = rng.below(10); i > 0; --i) text += "a\"\\\n\t#'=]\x7f\xc3\xa9"[rng.below(10)];
        return text;
    };
    for (const MixField& field : mix_fields()) field.set(mix, random_value(field.parameter));
    settle_fields(mix);
    if (mix.lengths.max < mix.lengths.min) mix.lengths.max = 0;
    for (MixStrategy& s : mix.strategies) {
        s.weight = std::get<double>(random_value(weight_parameter()));
        s.label += "-" + std::to_string(rng.below(100));
        for (const Parameter& p : s.info->parameters) s.parameters[p.name] = random_value(p);
        if (!settle(s).empty()) s.parameters["s1"] = s.parameters["s2"];
    }
    if (contradiction(mix)) mix.techniques = {};
    return mix;
}

TEST(MixFile, ReadsBackWhatItWrote) {
    Rng rng(1);
    for (int i = 0; i < 300; ++i) {
        const Mix mix = random_mix(rng);
        const std::string text = write_mix(mix);
        const Mix read = parse_mix(text, "x.toml");
        ASSERT_EQ(read, mix) << text;
        ASSERT_EQ(write_mix(read), text);
    }
}

TEST(Settings, ChangeEveryKey) {
    Mix mix = builtin_mix("mmlt");
    apply_settings(mix, {{"small-step.sigma", "0.02", "--set"},  // has an effect by the next one
                         {"small-step.kernel", "gaussian", "--set"},
                         {"large-step.weight", "2", "--set"},
                         {"target", "max-channel", "--set"},
                         {"lengths.per-chain", "fixed", "--set"},
                         {"lengths.max", "7", "--max-length"},
                         {"lengths.max", "scene", "--set"},
                         {"chains.count", "64", "--chains"},
                         {"seed", "5", "--seed"}});
    EXPECT_EQ(mix.strategies[1].parameters.at("sigma"), Value(0.02));
    EXPECT_EQ(mix.strategies[0].weight, 2);
    EXPECT_EQ(mix.target, TargetFunction::max_channel);
    EXPECT_EQ(mix.lengths, (PathLengths{1, 0, true}));
    EXPECT_EQ(mix.chain_count, 64);
    EXPECT_EQ(mix.seed, 5u);
    EXPECT_EQ(parse_mix(write_mix(mix), "x.toml"), mix);
}

TEST(Settings, AreRefusedWithWhatIsValid) {
    const auto message = [](const std::string& key, const std::string& text) {
        return error_of([&] {
            Mix mix = builtin_mix("mmlt");
            apply_settings(mix, {{key, text, "--set"}});
        });
    };
    EXPECT_THAT(message("small-step.sgima", "1"),
                HasSubstr("--set: unknown key 'small-step.sgima'; did you mean 'small-step.sigma'?"));
    EXPECT_THAT(message("portal.sigma", "1"), HasSubstr("unknown key 'portal.sigma'; valid names: name, "));
    EXPECT_EQ(message("small-step.s1", "big"),
              "--set: 'big' is not valid here; valid: a number above 0 to 0.5 of the unit cube's side");
    EXPECT_EQ(message("chains.count", "0"),
              "--set: '0' is not valid here; valid: an integer from 1 to 1073741824 or \"auto\"");
    EXPECT_THAT(message("small-step.kernel", "gausian"), HasSubstr("did you mean 'gaussian'?"));
    EXPECT_EQ(message("small-step.sigma", "0.1"),
              "--set: small-step.sigma has no effect here; it needs small-step.kernel=gaussian");
    EXPECT_EQ(message("small-step.s1", "0.5"), "small-step: s1 = 0.5 is above s2 = 0.015625");
    EXPECT_THAT(message("large-step.weight", "0"), HasSubstr("reaches every path"));
    EXPECT_THAT(message("retry-scale", "0.5"), HasSubstr("it needs rectification=retry"));
}

TEST(Registry, EveryEntryIsDocumentedAndMakesItsStrategy) {
    const auto scene = own_scene("three-planes");  // it has a portal
    const CoordinateLayout layout(*scene, 5);
    ChartEvaluator evaluator(*scene, layout, {}, {.path = true, .forgets = true, .measure = true});
    const TechniqueDistribution techniques(1, 5);
    const StrategyContext context{evaluator, &evaluator, techniques, {1, 5, false}, {}};
    for (const StrategyInfo& info : strategy_registry()) {
        EXPECT_EQ(&find_strategy(info.name), &info);
        EXPECT_NE(info.description, "");
        EXPECT_EQ(info.hindrance(*scene, context.lengths), "") << info.name;
        Values values;
        for (const Parameter& p : info.parameters) {
            EXPECT_NE(p.description, "") << info.name << '.' << p.name;
            EXPECT_EQ(checked(p, p.fallback), p.fallback) << info.name << '.' << p.name;
            values[p.name] = p.fallback;
        }
        EXPECT_EQ(info.make(context, values)->name(), info.name);
    }
    EXPECT_NE(find_strategy("technique-change").hindrance(*scene, {1, 1, false}), "");
}

}  // namespace
}  // namespace keyhole
