// What is said of knobs follows from the figures of their settings.
#include "compare/tradeoff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace keyhole {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json estimate(double mean, double low, double high) { return {{"mean", mean}, {"low", low}, {"high", high}}; }

json entry(const std::string& name, double relmse, double squared_bias) {
    return {{"name", name},
            {"convergence",
             {{{"cpu_seconds", 2.0},
               {"mutations", 1e6},
               {"relmse", estimate(relmse, 0.8 * relmse, 1.2 * relmse)},
               {"variance", estimate(relmse - squared_bias, 0, relmse)},
               {"squared_bias", estimate(squared_bias, 0.9 * squared_bias, 1.1 * squared_bias)}}}}};
}

json with_knob(json e, const std::string& knob, const std::string& value, const json& speed_up) {
    e["knob"] = {{"name", knob}, {"value", value}};
    e["speed_up"] = speed_up;
    return e;
}

TEST(Tradeoff, SettingsHaveTimeErrorAndEfficiency) {
    const json results = {
        {"entries",
         {entry("base", 0.1, 0), with_knob(entry("steps=2", 0.05, 0), "steps", "2", estimate(2, 1.5, 2.5))}}};
    const json tradeoff = make_tradeoff(results, {{"steps", "1"}});
    ASSERT_EQ(tradeoff.size(), 1u);
    const json& settings = tradeoff[0].at("settings");
    ASSERT_EQ(settings.size(), 2u);
    EXPECT_EQ(settings[0].at("value"), "1");
    EXPECT_EQ(settings[1].at("entry"), "steps=2");
    EXPECT_DOUBLE_EQ(settings[1].at("microseconds_per_mutation"), 2);
    EXPECT_DOUBLE_EQ(settings[1].at("efficiency").at("mean"), 10);
    EXPECT_DOUBLE_EQ(settings[1].at("efficiency").at("low"), 1 / (2 * 0.06));
    EXPECT_EQ(tradeoff[0].at("conclusion"), "2 is better than 1: the same error 2 [1.5, 2.5] times as fast");
}

TEST(Tradeoff, ConclusionsFollowTheIntervals) {
    const auto conclude = [](const std::vector<json>& speed_ups) {
        json results = {{"entries", {entry("base", 0.1, 0)}}};
        for (std::size_t i = 0; i < speed_ups.size(); ++i)
            results["entries"].push_back(
                with_knob(entry(std::to_string(i), 0.1, 0), "k", "v" + std::to_string(i), speed_ups[i]));
        return make_tradeoff(results, {{"k", "v"}})[0].at("conclusion").get<std::string>();
    };
    EXPECT_EQ(conclude({estimate(0.5, 0.3, 0.7), estimate(0.8, 0.7, 0.9)}),
              "v is best; the next, v1, is 0.8 [0.7, 0.9] times as fast");
    EXPECT_EQ(conclude({estimate(1.2, 0.9, 1.5), estimate(0.8, 0.7, 0.9)}),
              "no setting is surely better than v; the best seen, v0, is 1.2 [0.9, 1.5] times as fast");
}

// However fast.
TEST(Tradeoff, NamesBiasAndCallsItNeverBetter) {
    json results = {{"entries", {entry("base", 0.1, 0.001)}}};
    results["entries"].push_back(
        with_knob(entry("rectification=exclude", 0.1, 0.06), "rectification", "exclude", estimate(3, 2, 4)));
    EXPECT_THAT(make_tradeoff(results, {{"rectification", "off"}})[0].at("conclusion").get<std::string>(),
                HasSubstr("nothing to set against off; exclude is biased: 60% of its squared error"));
}

TEST(Tradeoff, LeavesOutWhatWasNotMeasured) {
    json unfinished = with_knob(entry("steps=4", 0.1, 0), "steps", "4", estimate(1, 0, 2));
    unfinished.erase("convergence");
    const json base = entry("base", 0.1, 0);
    EXPECT_TRUE(make_tradeoff({{"entries", {base, unfinished}}}, {{"steps", "1"}}).empty());
    EXPECT_TRUE(make_tradeoff({{"entries", json::array()}}, json::object()).empty());
}

}  // namespace
}  // namespace keyhole
