#include "strategies/registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "strategies/path_space_strategies.h"

namespace keyhole {
namespace {

std::string applies_always(const Scene&, const PathLengths&) { return ""; }

StrategyInfo large_step() {
    StrategyInfo info;
    info.name = "large-step";
    info.description = "A path that is independent of the current one: length, technique and all coordinates anew";
    info.ergodic = info.independent = info.all_at_once = true;
    info.hindrance = applies_always;
    info.make = [](const StrategyContext& c, const Values&) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<LargeStep>(c.evaluator, c.techniques, c.lengths.fixed, c.rectification);
    };
    return info;
}

// The parameters of a symmetric step, of any strategy that makes one.
StrategyInfo with_kernel() {
    constexpr double half = 0.5;  // no point of the torus is farther
    const auto step = [&](const char* name, double fallback, const char* kernel, const char* description) {
        return Parameter::number(name, fallback, 0, half, description)
            .open()
            .of_step()
            .in("of the unit cube's side")
            .only_with("kernel", kernel);
    };
    StrategyInfo info;
    info.parameters = {Parameter::choice("kernel", {"kelemen", "gaussian"}, "distribution of the steps"),
                       step("s1", 1.0 / 1024, "kelemen", "smallest step"),
                       step("s2", 1.0 / 64, "kelemen", "largest step; their logarithms are uniform"),
                       step("sigma", 0.01, "gaussian", "standard deviation")};
    info.hindrance = applies_always;
    info.contradiction = [](const Values& v) {
        const double s1 = number(v, "s1"), s2 = number(v, "s2");
        return s1 > s2 ? fmt::format("s1 = {} is above s2 = {}", s1, s2) : "";
    };
    return info;
}

// make(kernel) gives the strategy.
template <class Make>
std::unique_ptr<PssStrategy> make_with_kernel(const Values& v, const Make& make) {
    if (is_choice(v, "kernel", "gaussian")) return make(GaussianKernel(number(v, "sigma")));
    return make(KelemenKernel(number(v, "s1"), number(v, "s2")));
}

StrategyInfo small_step() {
    StrategyInfo info = with_kernel();
    info.name = "small-step";
    info.description = "Moves every coordinate of the current technique by a small symmetric step";
    info.all_at_once = true;
    info.make = [](const StrategyContext& c, const Values& v) {
        return make_with_kernel(v, [&]<class Kernel>(const Kernel& kernel) -> std::unique_ptr<PssStrategy> {
            return std::make_unique<SmallStep<Kernel>>(c.evaluator, kernel, c.rectification);
        });
    };
    return info;
}

StrategyInfo inverse_small_step() {
    StrategyInfo info = with_kernel();
    info.name = "inverse-small-step";
    info.description = "Moves a path by a small step in the coordinates of a technique drawn for it, from the inverse";
    info.needs = {.path = true, .forgets = true};
    info.make = [](const StrategyContext& c, const Values& v) {
        return make_with_kernel(v, [&]<class Kernel>(const Kernel& kernel) -> std::unique_ptr<PssStrategy> {
            return std::make_unique<InverseSmallStep<Kernel>>(*c.charts, c.techniques, kernel);
        });
    };
    return info;
}

StrategyInfo to_other_technique(const char* name, const char* description) {
    StrategyInfo info;
    info.name = name;
    info.description = description;
    info.hindrance = [](const Scene&, const PathLengths& lengths) {
        return std::string(lengths.max > 1 ? "" : "paths of one edge have one technique only");
    };
    return info;
}

StrategyInfo technique_change() {
    StrategyInfo info = to_other_technique(
        "technique-change",
        "Keeps the coordinates and reads them by another technique of the same length: another path");
    info.make = [](const StrategyContext& c, const Values&) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<TechniqueChange>(c.evaluator, c.techniques);
    };
    return info;
}

template <class Move>
StrategyInfo chart_move(const char* name, const char* description) {
    StrategyInfo info = to_other_technique(name, description);
    info.needs = {.path = true};
    info.make = [](const StrategyContext& c, const Values&) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<Move>(*c.charts, c.techniques);
    };
    return info;
}

}  // namespace

const std::vector<StrategyInfo>& strategy_registry() {
    static const std::vector<StrategyInfo> registry = [] {
        std::vector<StrategyInfo> all = {
            large_step(),
            small_step(),
            technique_change(),
            chart_move<ChartSwap>(
                "chart-swap",
                "Keeps the path and goes over to another technique, with coordinates from the exact inverse"),
            chart_move<ChartGibbs>(
                "chart-gibbs",
                "As chart-swap, but draws the technique from its distribution given the path: never rejected"),
            inverse_small_step()};
        for (StrategyInfo& info : path_space_strategies()) all.push_back(std::move(info));
        return all;
    }();
    return registry;
}

const StrategyInfo& find_strategy(const std::string& name) {
    const auto& registry = strategy_registry();
    const auto found = std::find_if(registry.begin(), registry.end(), [&](const auto& s) { return s.name == name; });
    if (found != registry.end()) return *found;
    std::vector<std::string> names;
    for (const StrategyInfo& s : registry) names.push_back(s.name);
    throw InputError({}, fmt::format("unknown strategy '{}'; {}", name, valid_names(name, names)));
}

}  // namespace keyhole
