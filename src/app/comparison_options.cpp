#include "app/comparison_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "app/command.h"
#include "app/interrupt.h"
#include "app/mix_options.h"
#include "app/outputs.h"
#include "app/report.h"
#include "app/version.h"
#include "base/error.h"
#include "base/process.h"
#include "base/units.h"

namespace keyhole {
namespace {

constexpr double default_time = 60;
constexpr double reference_times = 10;  // as long as this many runs
constexpr const char* length_group = "Length of the runs";
constexpr const char* reference_group = "Reference";
constexpr const char* path_group = "Paths and chains";
constexpr const char* output_group = "Output";

void add_length_options(CLI::App& command, ComparisonOptions& options) {
    const auto time = [&options](const std::string& text) {
        options.time = parse_duration(text);
        if (options.time <= 0) throw InputError({}, "'" + text + "' is not above zero");
    };
    add_parsed(command, "-t,--time", "TIME", time,
               "Of each run, such as 60s or 10m; with --equal cpu the processor time of all threads [default: 60s]")
        ->group(length_group);
    add_real(command, "-n,--mutations-per-pixel", options.mutations, 0, 1e12,
             "Of each run: mutations (mixes) or samples (path, bdpt) per pixel; stands for --equal mutations", true)
        ->group(length_group);
    const auto equal = [&options](std::size_t i) { options.equal = std::array{"time", "cpu", "mutations"}[i]; };
    add_choice(command, "--equal", {"time", "cpu", "mutations"}, equal,
               "What all entries get the same amount of [default: time]")
        ->group(length_group);
    add_integer(command, "--runs", options.plan.runs, 1, 100000,
                "Independent runs of each entry; intervals need two or more [default: 10]")
        ->group(length_group);
    add_integer(command, "--threads", options.plan.threads, 0, 4096, "Threads of each run; 0: all [default: 0]")
        ->group(length_group);
}

void add_reference_options(CLI::App& command, ComparisonOptions& options) {
    const auto file = [&options](const std::string& text) { options.plan.reference_file = text; };
    const auto time = [&options](const std::string& text) {
        options.reference_time = parse_duration(text);
        if (options.reference_time <= 0) throw InputError({}, "'" + text + "' is not above zero");
    };
    const auto integrator = [&options](std::size_t i) {
        options.plan.reference_integrator = std::array{Integrator::bdpt, Integrator::path}[i];
    };
    CLI::Option* given = add_parsed(command, "--reference", "FILE", file,
                                    "An image to measure errors against, in place of one made here");
    CLI::Option* made = add_parsed(command, "--reference-time", "TIME", time,
                                   "How long to make one, in all; a longer time in a later call goes on with it "
                                   "[default: as long as 10 runs]");
    given->group(reference_group)->excludes(made);
    made->group(reference_group);
    add_choice(command, "--reference-integrator", {"bdpt", "path"}, integrator, "What makes it [default: bdpt]")
        ->group(reference_group)
        ->excludes(given);
}

void add_path_options(CLI::App& command, ComparisonOptions& options) {
    add_mix_key(command, options.mix, "--max-length", "lengths.max",
                "Most edges of a path, of all entries and the reference")
        ->group(path_group);
    add_mix_key(command, options.mix, "--min-length", "lengths.min", "Fewest edges of a path")->group(path_group);
}

void add_output_options(CLI::App& command, ComparisonOptions& options) {
    const auto folder = [&options](const std::string& text) { options.plan.folder = text; };
    add_parsed(command, "-o,--output", "DIR", folder,
               "Folder for everything [default: the scene's name and -" + command.get_name() + ", here]")
        ->group(output_group);
    command
        .add_flag("--discard", options.plan.discard,
                  "Delete runs in the folder that are of another scene, mix, program or length")
        ->group(output_group);
    CLI::Option* quiet = command.add_flag("-q,--quiet", options.quiet, "Say nothing but warnings and errors");
    CLI::Option* verbose = command.add_flag("-v,--verbose", options.verbose, "Say more often how far it is");
    quiet->group(output_group);
    verbose->group(output_group)->excludes(quiet);
}

// Fills in what depends on other options.
void complete(ComparisonOptions& options, const std::string& command_name) {
    ComparisonPlan& plan = options.plan;
    if (options.equal.empty()) options.equal = options.mutations > 0 ? "mutations" : "time";
    for (const EqualCost cost : {EqualCost::time, EqualCost::cpu, EqualCost::mutations})
        if (options.equal == name_of(cost)) plan.equal = cost;
    const bool mutations = plan.equal == EqualCost::mutations;
    if (mutations && options.mutations == 0)
        throw InputError({}, "--equal mutations needs their number: --mutations-per-pixel");
    if (mutations && options.time > 0) throw InputError({}, "--time has no effect with --equal mutations");
    if (!mutations && options.mutations > 0)
        throw InputError({}, "--mutations-per-pixel has no effect with --equal " + options.equal);
    if (options.time == 0) options.time = default_time;
    plan.budget = mutations ? options.mutations : options.time;
    plan.reference_seconds = options.reference_time > 0 ? options.reference_time : reference_times * options.time;
    plan.scene_file = options.scene.filename;
    plan.scene_name = scene_name(options.scene.filename);
    if (plan.folder.empty()) plan.folder = plan.scene_name + "-" + command_name;
    plan.command = command_line();
    plan.program = version();
}

std::string estimate_text(const nlohmann::json& estimate) {
    if (!estimate.contains("low")) return fmt::format("{:.3g}", estimate.at("mean").get<double>());
    const auto number = [&](const char* name) {
        return estimate.at(name).is_null() ? std::numeric_limits<double>::quiet_NaN() : estimate.at(name).get<double>();
    };
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", number("mean"), number("low"), number("high"));
}

void print_results(const nlohmann::json& results) {
    fmt::print("{:<24} {:>4}  {:<28} {:<28} {:<28} {}\n", "", "runs", "relMSE [95% interval]", "variance",
               "squared bias", "speed-up");
    for (const nlohmann::json& entry : results.at("entries")) {
        if (!entry.contains("metrics")) {
            fmt::print("{:<24} {:>4}\n", entry.at("name").get<std::string>(), 0);
            continue;
        }
        const auto optional = [&](const nlohmann::json& of, const char* name) {
            return of.contains(name) ? estimate_text(of.at(name)) : std::string("-");
        };
        const nlohmann::json split = entry.value("split", nlohmann::json::object());
        fmt::print("{:<24} {:>4}  {:<28} {:<28} {:<28} {}\n", entry.at("name").get<std::string>(),
                   entry.at("runs").get<int>(), estimate_text(entry.at("metrics").at("relmse")),
                   optional(split, "variance"), optional(split, "squared_bias"), optional(entry, "speed_up"));
    }
    const nlohmann::json& reference = results.at("reference");
    if (reference.contains("relmse"))
        fmt::print("relMSE of the reference: {:.2g}\n", reference.at("relmse").get<double>());
}

std::size_t warning_count(const nlohmann::json& results) {
    std::size_t count = 0;
    for (const nlohmann::json& entry : results.at("entries"))
        count += entry.value("warnings", nlohmann::json::array()).size();
    return count;
}

}  // namespace

const char* const comparison_footer = R"(
DIR holds results.json (docs/results.schema.json), index.html (one page that shows
everything, without a network), reference.exr, and the image of every run after
1/64, 1/32, ... 1 of its length. Called again with the same options and folder, the
command goes on where it ended; with more --runs it adds some. A changed scene,
mix, program or length is an error unless --discard is given. Every run has a seed
of its own, made from --seed, its entry's name and its number.

Ctrl-C ends the run at hand, which is lost, and writes results from the others;
the second Ctrl-C quits at once.

Exit codes: 0 done; 1 failure while running; 2 options or input not valid; 130,
143, 129 ended by Ctrl-C, SIGTERM, SIGHUP.)";

void add_comparison_options(CLI::App& command, ComparisonOptions& options) {
    add_scene_options(command, options.scene);
    add_length_options(command, options);
    add_reference_options(command, options);
    add_path_options(command, options);
    const auto set = [&options](const Setting& s) { options.mix.settings.push_back(s); };
    add_set_option(command, set)->group(path_group);
    const auto seed = [&options](const std::string& text) { options.plan.seed = parse_unsigned(text); };
    add_parsed(command, "--seed", "INTEGER", seed, "From which the seeds of all runs are made [default: 0]")
        ->group(path_group);
    add_output_options(command, options);
}

ComparedEntry integrator_entry(const ComparisonOptions& options, Integrator integrator) {
    ComparedEntry entry;
    entry.name = integrator_name(integrator);
    entry.integrator = integrator;
    for (const Setting& s : options.mix.settings)
        if (s.key == "lengths.min" || s.key == "lengths.max") set_value(entry.mix, s.key, s.text);
    return entry;
}

int run_comparison_command(ComparisonOptions options, std::vector<ComparedEntry> entries) {
    const std::string command = entries.front().parameter ? "sweep" : "compare";
    return run_comparison_command(std::move(options), command,
                                  [&](const LoadedScene&, ComparisonPlan&) { return std::move(entries); });
}

int run_comparison_command(ComparisonOptions options, const std::string& command, const MakeEntries& make) {
    complete(options, command);
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    options.plan.entries = make(loaded, options.plan);
    const Verbosity verbosity = options.quiet     ? Verbosity::quiet
                                : options.verbose ? Verbosity::verbose
                                                  : Verbosity::normal;
    ProgressLine line(verbosity, "mutations");
    for (const std::string& warning : loaded.warnings) line.warn(warning);

    const InterruptGuard interrupt(!options.quiet);
    ComparisonCallbacks callbacks;
    callbacks.progress = [&line](const Progress& p) { line.show(p); };
    callbacks.stop = [&interrupt] { return interrupt.signal() != 0; };
    callbacks.warn = [&line](const std::string& message) { line.warn(message); };
    callbacks.describe = [&](const RenderSettings& settings, const RenderStatistics& statistics) {
        Json report = describe_run(options.scene, loaded, settings);
        if (statistics.mutations > 0) add_statistics(report, settings, *loaded.scene, statistics);
        return image_metadata(report);
    };
    const ComparisonOutcome outcome = run_comparison(*loaded.scene, options.plan, callbacks);
    line.clear();
    if (!outcome.results.is_null() && !options.quiet) {
        print_results(outcome.results);
        for (const Json& knob : outcome.results.value("tradeoff", Json::array()))
            fmt::print("{}: {}\n", knob.at("knob").get<std::string>(), knob.at("conclusion").get<std::string>());
        if (const std::size_t count = warning_count(outcome.results); count > 0)
            fmt::print("{} warning{} of entries: see the page\n", count, count == 1 ? "" : "s");
        const std::filesystem::path folder(options.plan.folder);
        for (const char* name : {"results.json", "index.html"}) fmt::print("wrote {}\n", (folder / name).string());
    }
    if (interrupt.signal() == 0) return exit_success;
    if (!options.quiet) fmt::print("interrupted; the same command goes on from here\n");
    return exit_signal + interrupt.signal();
}

}  // namespace keyhole
