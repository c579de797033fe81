// `keyhole render`
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/command.h"
#include "app/interrupt.h"
#include "app/outputs.h"
#include "app/render_options.h"
#include "app/report.h"
#include "app/version.h"
#include "base/units.h"

namespace keyhole {
namespace {

std::string scene_summary(const LoadedScene& loaded) {
    const SceneStatistics& s = loaded.scene->statistics();
    const FilmSettings& film = loaded.scene->film();
    return fmt::format("{} triangles, {} emitters, {}x{} pixels; read in {}, built in {}", s.triangles, s.emitters,
                       film.crop_width, film.crop_height, format_duration(loaded.seconds_reading),
                       format_duration(loaded.seconds_building));
}

void print_scene(const RenderOptions& options, const LoadedScene& loaded, ProgressLine& line) {
    for (const std::string& warning : loaded.warnings) line.warn(warning);
    if (!options.verbose) return;
    fmt::print(stderr, "{}: {}\n", options.scene.filename, scene_summary(loaded));
    for (const std::string& unused : loaded.unused) fmt::print(stderr, "unused: {}\n", unused);
}

void print_strategies(const RenderStatistics& statistics) {
    for (const StrategyStatistics& s : statistics.strategies) {
        std::string failures;
        for (const auto& [kind, count] : s.failures)
            failures += fmt::format("{}{} {}", failures.empty() ? "; failures: " : ", ", kind, count);
        fmt::print(
            "  {:<17} {:>8} proposals, {:5.1f}% accepted, at most {} effective samples of luminance, {} of "
            "position{}\n",
            s.name, format_count(static_cast<double>(s.proposals)), 100 * s.mean_acceptance,
            format_count(s.luminance.effective_sample_size), format_count(s.position.effective_sample_size), failures);
    }
}

void print_tuning(const TuningStatistics& t, bool verbose) {
    if (t.contenders.empty()) return;
    fmt::print("mix: {}, {} {} that raced for {} (CPU)\n", t.winner,
               t.clear ? "the best of" : "as there was no clear winner among", t.contenders.size(),
               format_duration(t.cpu_seconds));
    if (!verbose) return;
    for (const auto& c : t.contenders)
        fmt::print("  {:<48} {:>8} mutations in {}, error {:.3g}\n", c.name, format_count(c.mutations),
                   format_duration(c.cpu_seconds), c.error);
}

// What the disagreement of replicates says.
void print_errors(const ErrorStatistics& e, bool verbose) {
    if (e.replicates == 0) return;
    fmt::print("blocks of the image (16x16) {:.2g}% standard error, by {} replicates; {} effective samples\n",
               100 * e.blocks_relative, e.replicates, format_count(e.position.effective_sample_size));
    if (!verbose) return;
    fmt::print(
        "autocorrelation time of luminance {:.3g} mutations, of position {:.3g}; standard error of the image's "
        "mean {:.2g}\n",
        e.luminance.autocorrelation_time, e.position.autocorrelation_time, e.image_mean);
    fmt::print("independent samples are worth {} effective paths, the five largest carry {:.2g}% of the light\n",
               format_count(e.effective_paths), 100 * e.heaviest_share);
}

void print_summary(const RenderOptions& options, const Json& report, const RenderStatistics& s) {
    const Json& numbers = report.at("statistics");
    const char* unit = work_unit(options.settings.integrator);
    const std::string acceptance =
        overall_acceptance(s) < 0 ? "" : fmt::format(", {:.1f}% accepted", 100 * overall_acceptance(s));
    fmt::print("{} in {}: {:.6g} {} per pixel, {} {}/s{}\n", s.interrupted ? "interrupted" : "rendered",
               format_duration(s.seconds_bootstrap + s.seconds_render), numbers.at("mutations_per_pixel").get<double>(),
               unit, format_count(numbers.at("mutations_per_second").get<double>()), unit, acceptance);
    if (s.tuning) print_tuning(*s.tuning, options.verbose);
    const bool luminance =
        options.settings.integrator != Integrator::mmlt || options.settings.mix.target == TargetFunction::luminance;
    fmt::print("mean {} {:.6g}{}\n", luminance ? "luminance" : "of the paths' largest channel", s.b,
               std::isfinite(s.b_standard_error) ? fmt::format(", standard error {:.2g}", s.b_standard_error) : "");
    print_errors(s.errors, options.verbose);
    if (!options.verbose) return;
    fmt::print("{} rays/s, {} threads, {} CPU, peak memory {}\n",
               format_count(numbers.at("rays_per_second").get<double>()), s.threads, format_duration(s.cpu_seconds),
               format_bytes(s.peak_memory_bytes));
    print_strategies(s);
}

void print_files(const Outputs& outputs, bool tuned) {
    for (const std::string& name : outputs.images()) fmt::print("wrote {}\n", name);
    if (!outputs.error_image().empty()) fmt::print("wrote {}\n", outputs.error_image());
    fmt::print("wrote {}\n", outputs.report());
    if (tuned) fmt::print("wrote {}\n", outputs.mix());
}

RenderCallbacks make_callbacks(const Outputs& outputs, const Json& run, const InterruptGuard& interrupt,
                               ProgressLine& line) {
    RenderCallbacks callbacks;
    callbacks.progress = [&line](const Progress& progress) { line.show(progress); };
    callbacks.stop = [&interrupt] { return interrupt.signal() != 0; };
    // A preview that cannot be written must not end the run: the final image may find room again.
    callbacks.preview = [&outputs, &run, &line, warned = false](const Image& image) mutable {
        try {
            outputs.write_preview(image, run);
        } catch (const std::exception& e) {
            if (!std::exchange(warned, true)) line.warn(std::string("no preview: ") + e.what());
        }
    };
    return callbacks;
}

// Why the image cannot be expected to be that of --like, bit for bit.
std::vector<std::string> differences(const RenderOptions& options, const Scene& scene) {
    std::vector<std::string> warnings;
    if (!options.stored) return warnings;
    if (scene_hash(scene) != options.stored->scene_hash)
        warnings.push_back("the scene is not the one that '" + options.like + "' was made of");
    if (version() != options.stored->version)
        warnings.push_back(
            fmt::format("'{}' was made by version {}, this is {}", options.like, options.stored->version, version()));
    return warnings;
}

int run_render(const RenderOptions& options) {
    std::unique_ptr<tbb::global_control> threads;
    if (options.settings.threads > 0)
        threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        static_cast<std::size_t>(options.settings.threads));
    const Outputs outputs(options.outputs, options.scene.filename, options.exposure, options.error_image);
    LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    for (std::string& warning : differences(options, *loaded.scene)) loaded.warnings.push_back(std::move(warning));
    const RenderSettings settings = resolve(*loaded.scene, options.settings);
    ProgressLine line(options.verbosity(), work_unit(settings.integrator));
    print_scene(options, loaded, line);

    Json report = describe_run(options.scene, loaded, settings);
    const InterruptGuard interrupt(!options.quiet);
    const RenderResult result = render(*loaded.scene, settings, make_callbacks(outputs, report, interrupt, line));
    line.clear();
    const RenderStatistics& statistics = result.statistics;
    std::vector<std::string> warnings = loaded.warnings;
    for (const std::string& warning : statistics.warnings) {
        line.warn(warning);
        warnings.push_back(warning);
    }
    if (interrupt.signal() != 0 && statistics.mutations == 0) {
        line.warn("interrupted before the first pass; there is no image to write");
        return exit_signal + interrupt.signal();
    }
    add_statistics(report, settings, *loaded.scene, statistics);
    report["warnings"] = warnings;
    // Files first: whatever happens to the terminal, they are safe.
    const std::vector<std::string> failures = outputs.write(result.image, result.error, report);
    for (const std::string& failure : failures) print_error(failure);
    if (!options.quiet) print_summary(options, report, statistics);
    if (!failures.empty()) return exit_failure;
    if (!options.quiet) print_files(outputs, statistics.tuning.has_value());
    return interrupt.signal() != 0 ? exit_signal + interrupt.signal() : exit_success;
}

}  // namespace

void add_render_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = keyhole.add_subcommand("render", "Render a scene to an image");
    add_render_options(*command, *options);
    command->callback([command, options, &runner] {
        complete_render_options(*command, *options);
        runner = [options] { return run_render(*options); };
    });
}

}  // namespace keyhole
