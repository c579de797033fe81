// MMLT with each policy for failing proposals, on three of the project's own scenes: how the variance and the squared
// bias of the image go with time.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "chain/running_mean.h"
#include "compare/comparison.h"
#include "compare/error_split.h"
#include "compare/run_store.h"
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

// The mean of images and the variance of that mean.
struct Pool {
    Image mean, variance;
};

Pool pool(const std::vector<Image>& images) {
    Pool result{images.front(), images.front()};
    for (std::size_t i = 0; i < result.mean.rgb.size(); ++i) {
        RunningMean value;
        for (const Image& image : images) value.add(static_cast<double>(image.rgb[i]));
        result.mean.rgb[i] = static_cast<float>(value.mean());
        result.variance.rgb[i] = static_cast<float>(sqr(value.standard_error()));
    }
    return result;
}

// The runs of one scene, as the comparison has stored them.
class StoredRuns {
  public:
    StoredRuns(const std::string& folder, int runs) : runs_(runs) {
        for (const ComparedEntry& entry : entries()) {
            stores_.emplace_back(folder, entry.name, nlohmann::json::object());
            exact_.push_back(entry.mix.rectification.policy != Rectification::exclude);
        }
    }

    // What shares of a run, 1 / part, all runs have images of, in the order of time.
    std::vector<RunPart> parts(std::size_t entry) const {
        std::vector<RunPart> common = stores_[entry].record(1).parts;
        for (int run = 2; run <= runs_; ++run) {
            const std::vector<RunPart> own = stores_[entry].record(run).parts;
            std::erase_if(common, [&](const RunPart& p) {
                return std::none_of(own.begin(), own.end(), [&](const RunPart& o) { return o.part == p.part; });
            });
        }
        return common;
    }
    std::vector<Image> images(std::size_t entry, int part) const {
        std::vector<Image> result;
        for (int run = 1; run <= runs_; ++run) result.push_back(stores_[entry].image(run, part));
        return result;
    }
    // All complete runs of the exact policies but this one.
    Pool reference_of(std::size_t entry) const {
        std::vector<Image> all;
        for (std::size_t e = 0; e < stores_.size(); ++e)
            if (e != entry && exact_[e])
                for (Image& image : images(e, 1)) all.push_back(std::move(image));
        return pool(all);
    }
    double cpu_seconds(std::size_t entry, int part) const {
        double sum = 0;
        for (int run = 1; run <= runs_; ++run)
            for (const RunPart& p : stores_[entry].record(run).parts)
                if (p.part == part) sum += p.cpu_seconds / runs_;
        return sum;
    }

  private:
    int runs_;
    std::vector<RunStore> stores_;
    std::vector<char> exact_;
};

PlotPoint point(double x, const Estimate& e) {
    const Interval interval = e.interval.value_or(Interval{e.mean, e.mean});
    return {x, e.mean, interval.low, interval.high};
}

// Curves and the last figures of one scene. The true image is taken from the runs themselves: for each policy, the mean
// of all runs of the other exact ones. No other integrator finds the light of these scenes as well, and the noise of a
// reference that misses it would be taken for bias.
nlohmann::json judge(const std::string& scene, const StoredRuns& runs, std::vector<PlotPanel>& panels,
                     std::string& text) {
    PlotPanel panel{scene, "CPU-seconds", "variance (lines), squared bias (dashed), relative", {}};
    text += fmt::format("{}\n  {:<10}{:>34}{:>34}\n", scene, "at the end", "variance", "squared bias");
    nlohmann::json json;
    const std::vector<ComparedEntry> list = entries();
    for (std::size_t e = 0; e < list.size(); ++e) {
        const Pool reference = runs.reference_of(e);
        PlotSeries v{list[e].name, {}}, b{list[e].name, {}, true};
        for (const RunPart& part : runs.parts(e)) {
            const ErrorSplit split = split_error(runs.images(e, part.part), reference.mean, &reference.variance);
            const double x = runs.cpu_seconds(e, part.part);
            v.points.push_back(point(x, split.variance));
            b.points.push_back(point(x, split.squared_bias));
            json[list[e].name].push_back({{"cpu_seconds", x},
                                          {"variance", to_json(split.variance)},
                                          {"squared_bias", to_json(split.squared_bias)}});
        }
        const auto figure = [](const PlotPoint& p) {
            return fmt::format("{:.3g} [{:.3g}, {:.3g}]", p.y, p.low, p.high);
        };
        text += fmt::format("  {:<10}{:>34}{:>34}\n", v.name, figure(v.points.back()), figure(b.points.back()));
        // No point where it is not told from zero.
        std::erase_if(b.points, [](const PlotPoint& p) { return !(p.low > 0); });
        panel.series.push_back(v);
        panel.series.push_back(b);
    }
    panels.push_back(panel);
    return json;
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
        plan.reference_seconds = options.reference_seconds > 0 ? options.reference_seconds : 3 * plan.budget;
        plan.command = options.command;
        plan.program = options.program;
        ComparisonCallbacks of_comparison;
        of_comparison.progress = [&](Progress p) {
            p.phase = fmt::format("{}: {}", scene, p.phase);
            if (callbacks.progress) callbacks.progress(p);
        };
        of_comparison.stop = callbacks.stop;
        of_comparison.warn = [](const std::string&) {};  // of its own reference, which is not used here
        const ComparisonOutcome outcome = run_comparison(*loaded.scene, plan, of_comparison);
        if (!outcome.complete) {
            result.complete = false;
            return result;
        }
        result.json["scenes"][scene] = judge(scene, StoredRuns(plan.folder, plan.runs), panels, result.text);
    }
    result.svg = svg_plot("MMLT with failing proposals left out, walked on from, or retried: 95% intervals", panels);
    return result;
}

}  // namespace keyhole
