#include "compare/tradeoff.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace keyhole {
namespace {

using nlohmann::json;

double number_of(const json& estimate, const char* key, double fallback) {
    return estimate.contains(key) && estimate[key].is_number() ? estimate[key].get<double>() : fallback;
}

// 1 / (CPU time x relMSE), with the interval of relMSE.
json efficiency(double cpu_seconds, const json& relmse) {
    json j = {{"mean", 1 / (cpu_seconds * number_of(relmse, "mean", 0))}};
    const double low = number_of(relmse, "low", 0), high = number_of(relmse, "high", 0);
    if (high > 0) j["low"] = 1 / (cpu_seconds * high);
    if (low > 0) j["high"] = 1 / (cpu_seconds * low);
    return j;
}

json setting_json(const json& entry, const std::string& value) {
    const json& last = entry.at("convergence").back();
    const double seconds = last.at("cpu_seconds");
    json j = {{"entry", entry.at("name")},
              {"value", value},
              {"microseconds_per_mutation", 1e6 * seconds / last.at("mutations").get<double>()},
              {"relmse", last.at("relmse")},
              {"efficiency", efficiency(seconds, last.at("relmse"))}};
    for (const char* part : {"variance", "squared_bias"})
        if (last.contains(part)) j[part] = last.at(part);
    if (entry.contains("speed_up")) j["speed_up"] = entry.at("speed_up");
    return j;
}

// The share of a setting's error that is bias, where the runs show that there is some; else 0.
double bias_share(const json& setting) {
    if (!setting.contains("squared_bias")) return 0;
    const json& bias = setting["squared_bias"];
    const double error = number_of(setting["relmse"], "mean", 0);
    return number_of(bias, "low", 0) > 0 && error > 0 ? number_of(bias, "mean", 0) / error : 0;
}

std::string interval(const json& e) {
    return fmt::format("{:.2g} [{:.2g}, {:.2g}]", number_of(e, "mean", 0), number_of(e, "low", 0),
                       number_of(e, "high", 0));
}

// A biased setting is not called better: more time would not make it right.
std::string conclusion(const std::string& base, const json& settings) {
    const json* best = nullptr;
    bool all_worse = true;
    std::string biased;
    for (const json& s : settings) {
        if (!s.contains("speed_up")) continue;
        if (const double share = bias_share(s); share > 0.1 && share > bias_share(settings[0]) + 0.1) {
            biased +=
                fmt::format("; {} is biased: {:.0f}% of its squared error", s["value"].get<std::string>(), 100 * share);
            continue;
        }
        all_worse = all_worse && number_of(s["speed_up"], "high", 2) < 1;
        if (!best || number_of(s["speed_up"], "mean", 0) > number_of((*best)["speed_up"], "mean", 0)) best = &s;
    }
    if (!best) return fmt::format("nothing to set against {}{}", base, biased);
    const std::string value = (*best)["value"], factor = interval((*best)["speed_up"]);
    if (number_of((*best)["speed_up"], "low", 0) > 1)
        return fmt::format("{} is better than {}: the same error {} times as fast{}", value, base, factor, biased);
    if (all_worse) return fmt::format("{} is best; the next, {}, is {} times as fast{}", base, value, factor, biased);
    return fmt::format("no setting is surely better than {}; the best seen, {}, is {} times as fast{}", base, value,
                       factor, biased);
}

}  // namespace

json make_tradeoff(const json& results, const json& base) {
    json tradeoff = json::array();
    const json& entries = results.at("entries");
    const auto measured = [](const json& entry) { return entry.contains("convergence"); };
    if (entries.empty() || !measured(entries[0])) return tradeoff;
    for (const json& entry : entries) {
        if (!entry.contains("knob") || !measured(entry)) continue;
        const std::string name = entry["knob"]["name"];
        if (tradeoff.empty() || tradeoff.back()["knob"] != name) {
            const std::string value = base.at(name);
            tradeoff.push_back({{"knob", name}, {"settings", {setting_json(entries[0], value)}}});
        }
        tradeoff.back()["settings"].push_back(setting_json(entry, entry["knob"]["value"]));
    }
    for (json& knob : tradeoff) knob["conclusion"] = conclusion(knob["settings"][0]["value"], knob["settings"]);
    return tradeoff;
}

}  // namespace keyhole
