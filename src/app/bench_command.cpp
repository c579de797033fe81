// `keyhole bench`
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/mix_options.h"
#include "render/throughput.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
Runs the chains in slices and prints, as mean +- standard error over the slices:
  mutations per CPU-second and per second, for 1 thread and for --threads;
  the replay ratio: the time that Embree alone needs for the rays of a slice,
  cast again in the same order by the same threads, over the slice's time.
Single-edge paths are left out (--min-length 2), as they cost next to nothing.

Example: keyhole bench scenes/cornell-box.xml --size 256x256 --max-length 9)";

struct BenchOptions {
    SceneOptions scene;
    MixOptions mix;
    double seconds = 5;
    int threads = 2;
    bool json = false;
};

nlohmann::json to_json(const RunningMean& m) {
    return {{"mean", m.mean()}, {"standard_error", m.standard_error()}, {"slices", m.count()}};
}

nlohmann::json to_json(const Throughput& t) {
    return {{"threads", t.threads},
            {"mutations_per_cpu_second", to_json(t.mutations_per_cpu_second)},
            {"mutations_per_second", to_json(t.mutations_per_second)},
            {"replay_ratio", to_json(t.replay_ratio)},
            {"replayed_rays_per_cpu_second", to_json(t.replayed_rays_per_cpu_second)},
            {"rays_per_mutation", t.rays_per_mutation},
            {"mean_acceptance", t.mean_acceptance}};
}

std::string millions(const RunningMean& m) {
    return fmt::format("{:.3f} +- {:.3f}", m.mean() * 1e-6, m.standard_error() * 1e-6);
}

void print(const Throughput& t) {
    fmt::print("{} thread{}: {} million mutations per CPU-second, {} per second\n", t.threads, t.threads > 1 ? "s" : "",
               millions(t.mutations_per_cpu_second), millions(t.mutations_per_second));
    fmt::print("  {:.2f} rays per mutation; Embree alone casts {} million of them per CPU-second\n",
               t.rays_per_mutation, millions(t.replayed_rays_per_cpu_second));
    fmt::print("  replay ratio {:.3f} +- {:.3f}; acceptance {:.3f}\n", t.replay_ratio.mean(),
               t.replay_ratio.standard_error(), t.mean_acceptance);
}

int run(const BenchOptions& options) {
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    RenderSettings settings;
    settings.mutations_per_pixel = 1;  // the slices decide how long it runs
    settings.mix = options.mix.apply_found(settings.mix);
    std::vector<Throughput> results;
    results.push_back(measure_throughput(*loaded.scene, settings, 1, options.seconds));
    if (options.threads > 1)
        results.push_back(measure_throughput(*loaded.scene, settings, options.threads, options.seconds));
    const double speed_up = results.back().mutations_per_second.mean() / results.front().mutations_per_second.mean();
    if (options.json) {
        nlohmann::json json = {{"scene", options.scene.filename}, {"results", nlohmann::json::array()}};
        for (const Throughput& t : results) json["results"].push_back(to_json(t));
        json["speed_up"] = speed_up;
        fmt::print("{}\n", json.dump(2));
        return exit_success;
    }
    for (const Throughput& t : results) print(t);
    if (results.size() > 1) fmt::print("{} threads are {:.2f} times one\n", options.threads, speed_up);
    return exit_success;
}

}  // namespace

void add_bench_command(CLI::App& keyhole, Runner& runner) {
    auto options = std::make_shared<BenchOptions>();
    options->mix.settings.push_back({"lengths.min", "2", ""});  // unless the command line says another
    CLI::App& command =
        *keyhole.add_subcommand("bench", "Measure how fast the chains run and how much of it is Embree");
    add_scene_options(command, options->scene);
    add_real(command, "--seconds", options->seconds, 0.1, 3600, "Time for each number of threads");
    add_integer(command, "--threads", options->threads, 1, 1024, "Compare this many threads with one");
    add_mix_key(command, options->mix, "--min-length", "lengths.min", "Fewest edges of a path [default: 2]");
    add_mix_key(command, options->mix, "--max-length", "lengths.max",
                "Most edges of a path [default: what the scene says, else 12]");
    add_mix_options(command, options->mix);
    command.add_flag("--json", options->json, "Print the figures as JSON");
    command.footer(footer);
    command.callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
