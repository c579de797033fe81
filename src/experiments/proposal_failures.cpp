// MMLT with each policy for failing proposals, on three of the project's own scenes: how the variance and the squared
// bias of the image go with time.
#include <fmt/format.h>

#include <filesystem>

#include "compare/comparison.h"
#include "experiments/experiment.h"
#include "experiments/plot.h"
#include "scene/reader.h"

namespace keyhole {
namespace {

constexpr const char* scenes[] = {"keyhole-room", "ajar-door", "cornell-box"};
constexpr int width = 96, height = 60;  // small, so that the bias is seen beneath the noise

std::vector<ComparedEntry> entries() {
    const std::pair<const char*, Rectification> policies[] = {{"off", Rectification::off},
                                                              {"exclude", Rectification::exclude},
                                                              {"walk-on", Rectification::walk_on},
                                                              {"retry", Rectification::retry}};
    std::vector<ComparedEntry> result;
    for (const auto& [name, policy] : policies) {
        ComparedEntry entry;
        entry.name = name;
        entry.mix = builtin_mix("mmlt");
        entry.mix.name = name;
        entry.mix.rectification.policy = policy;
        result.push_back(entry);
    }
    return result;
}

PlotPoint point(double x, const nlohmann::json& estimate) {
    const auto number = [&](const char* key) {
        return estimate.contains(key) && estimate.at(key).is_number() ? estimate.at(key).get<double>() : 0.0;
    };
    const double mean = number("mean");
    return {x, mean, number("low"), std::max(mean, number("high"))};
}

// Curves and the last figures of one scene, from the comparison's results.
void add_scene(const std::string& scene, const nlohmann::json& results, std::vector<PlotPanel>& panels,
               std::string& text) {
    PlotPanel variance{scene, "CPU-seconds", "variance (relative)", {}},
        bias{scene, "CPU-seconds", "squared bias (relative)", {}};
    text += fmt::format("{}\n  {:<10}{:>34}{:>34}\n", scene, "at the end", "variance", "squared bias");
    for (const nlohmann::json& entry : results.at("entries")) {
        PlotSeries v{entry.at("name"), {}}, b = v;
        for (const nlohmann::json& p : entry.at("convergence")) {
            if (!p.contains("variance")) continue;
            const double x = p.at("cpu_seconds");
            v.points.push_back(point(x, p.at("variance")));
            b.points.push_back(point(x, p.at("squared_bias")));
        }
        if (!v.points.empty()) {
            const auto figure = [](const PlotPoint& p) {
                return fmt::format("{:.3g} [{:.3g}, {:.3g}]", p.y, p.low, p.high);
            };
            text += fmt::format("  {:<10}{:>34}{:>34}\n", v.name, figure(v.points.back()), figure(b.points.back()));
        }
        // Where chance has made it negative or it is not told from zero, there is no point.
        std::erase_if(b.points, [](const PlotPoint& p) { return !(p.low > 0); });
        variance.series.push_back(v);
        bias.series.push_back(b);
    }
    panels.push_back(variance);
    panels.push_back(bias);
}

}  // namespace

ExperimentResult run_proposal_failures(const ExperimentOptions& options, const ExperimentCallbacks& callbacks) {
    ExperimentResult result;
    std::vector<PlotPanel> panels;
    for (const char* scene : scenes) {
        ReaderOptions reader;
        reader.width = width;
        reader.height = height;
        ComparisonPlan plan;
        plan.scene_file = (std::filesystem::path(options.scenes) / (std::string(scene) + ".xml")).string();
        const LoadedScene loaded = read_scene(plan.scene_file, reader);
        plan.scene_name = scene;
        plan.folder = (std::filesystem::path(options.folder) / scene).string();
        plan.entries = entries();
        plan.equal = EqualCost::cpu;
        plan.budget = options.seconds > 0 ? options.seconds : 20;
        plan.runs = options.runs > 0 ? options.runs : 10;
        plan.threads = options.threads;
        plan.seed = options.seed;
        plan.reference_seconds = options.reference_seconds > 0 ? options.reference_seconds : 20 * plan.budget;
        plan.command = options.command;
        plan.program = options.program;
        ComparisonCallbacks of_comparison;
        of_comparison.progress = [&](Progress p) {
            p.phase = fmt::format("{}: {}", scene, p.phase);
            if (callbacks.progress) callbacks.progress(p);
        };
        of_comparison.stop = callbacks.stop;
        of_comparison.warn = callbacks.warn;
        const ComparisonOutcome outcome = run_comparison(*loaded.scene, plan, of_comparison);
        if (!outcome.complete) {
            result.complete = false;
            return result;
        }
        result.json["scenes"][scene] = outcome.results;
        add_scene(scene, outcome.results, panels, result.text);
    }
    result.svg = svg_plot("MMLT with failing proposals left out, walked on from, or retried: 95% intervals", panels);
    return result;
}

}  // namespace keyhole
