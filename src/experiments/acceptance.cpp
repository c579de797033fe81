// Table 1 of Otsu et al. 2018: how often perturbations are accepted, with steps of one size and with steps as large as
// the empty cones about the edges.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/experiment.h"
#include "experiments/plot.h"
#include "scene/reader.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

constexpr const char* own_scenes[] = {"ajar-door", "blinds", "box-in-the-sun", "keyhole-room", "tree", "four-holes"};
constexpr int longest = 14;
constexpr double default_seconds = 20;

// The perturbation as published: the paths of lens and multichain together, by angle, r in [0.05, 0.5].
Mix mix_of(const std::string& name, const std::string& suffix, const std::string& parameters) {
    std::string text = "name = \"" + name + "\"\n[[strategy]]\ntype = \"bidirectional\"\nweight = 0.25\n";
    for (const char* type : {"lens", "multichain"})
        text += fmt::format("[[strategy]]\ntype = \"{}{}\"\nweight = 0.75\n{}", type, suffix, parameters);
    return parse_mix(text, name);
}
std::vector<Mix> mixes() {
    return {mix_of("mlt", "", "primary = \"angle\"\nr-min = 0.05\nr-max = 0.5\n"),
            mix_of("geomlt-fast", "-geo", "estimator = \"fast\"\n"),
            mix_of("geomlt", "-geo", "estimator = \"bvh-cut\"\n")};
}

struct Row {
    std::string scene, mix;
    std::uint64_t mutations = 0;
    double overall = 0, perturbation = 0;
};

Row measure_row(const Scene& scene, const std::string& name, const Mix& mix, const ExperimentOptions& options,
                const RenderCallbacks& callbacks) {
    RenderSettings settings;
    settings.mix = mix;
    settings.mix.seed = options.seed;
    settings.mix.lengths.max = name == "four-holes" ? 1 : longest;
    settings.cpu_seconds = options.seconds > 0 ? options.seconds : default_seconds;
    settings.threads = options.threads;
    const RenderStatistics statistics = render(scene, settings, callbacks).statistics;
    Row row{name, mix.name};
    double accepted = 0, perturbed = 0, kept = 0;
    for (const StrategyStatistics& s : statistics.strategies) {
        row.mutations += s.proposals;
        accepted += static_cast<double>(s.accepted);
        if (s.name == "bidirectional") continue;
        perturbed += static_cast<double>(s.proposals);
        kept += static_cast<double>(s.accepted);
    }
    row.overall = row.mutations > 0 ? accepted / static_cast<double>(row.mutations) : 0;
    row.perturbation = perturbed > 0 ? kept / perturbed : 0;
    return row;
}

}  // namespace

ExperimentResult run_acceptance(const ExperimentOptions& options, const ExperimentCallbacks& callbacks) {
    struct Job {
        std::string name, file;
    };
    std::vector<Job> jobs;
    for (const std::string& file : options.scene_files)
        jobs.push_back(
            {std::filesystem::path(file).parent_path().filename() / std::filesystem::path(file).filename(), file});
    for (const char* name : own_scenes)
        jobs.push_back({name, (std::filesystem::path(options.scenes) / (std::string(name) + ".xml")).string()});

    ExperimentResult result;
    result.text =
        fmt::format("{:<26}{:<14}{:>14}{:>10}{:>14}\n", "scene", "method", "mutations", "overall", "perturbations");
    std::vector<PlotSeries> series;
    for (const Mix& mix : mixes()) series.push_back({mix.name, {}});
    ReaderOptions reader;
    reader.width = 320;
    reader.height = 200;
    const std::size_t renders = jobs.size() * series.size();
    std::size_t done = 0;
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        const auto scene = read_scene(jobs[j].file, reader).scene;
        for (std::size_t m = 0; m < series.size(); ++m) {
            RenderCallbacks render_callbacks;
            render_callbacks.stop = callbacks.stop;
            render_callbacks.progress = [&](Progress p) {
                p.phase = jobs[j].name + " " + series[m].name;
                p.fraction = (static_cast<double>(done) + p.fraction) / static_cast<double>(renders);
                p.remaining = -1;
                if (callbacks.progress) callbacks.progress(p);
            };
            const Row row = measure_row(*scene, jobs[j].name, mixes()[m], options, render_callbacks);
            if (callbacks.stop && callbacks.stop()) {
                result.complete = false;
                return result;
            }
            ++done;
            result.json["rows"].push_back({{"scene", row.scene},
                                           {"method", row.mix},
                                           {"mutations", row.mutations},
                                           {"overall_acceptance", row.overall},
                                           {"perturbation_acceptance", row.perturbation}});
            result.text += fmt::format("{:<26}{:<14}{:>14}{:>9.1f}%{:>13.1f}%\n", row.scene, row.mix, row.mutations,
                                       100 * row.overall, 100 * row.perturbation);
            series[m].points.push_back(
                {static_cast<double>(j + 1), row.perturbation, row.perturbation, row.perturbation});
        }
    }
    result.svg = svg_plot("Acceptance of perturbations",
                          {{"scenes in the order of the table", "scene", "accepted share", series}});
    return result;
}

}  // namespace keyhole
