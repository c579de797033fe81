// `keyhole experiment`
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/options.h"
#include "app/report.h"
#include "app/version.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/process.h"
#include "base/units.h"
#include "experiments/experiment.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
Writes DIR/results.json, DIR/picture.svg and what the experiment keeps beside them
(images, references, pages), and prints a table. Without a name, lists the experiments.

Examples:
  keyhole experiment proposal-failures-1d -o out/failures-1d
  keyhole experiment charted-toy -o out/toy --runs 3 --scale 0.1
      A tenth of the published numbers of samples
  keyhole experiment proposal-failures -o out/failures -t 5s
  keyhole experiment acceptance -o out/acceptance --scene ajar-door/scene.xml

Exit codes: 0 done; 1 failure while running; 2 options or input not valid; 130,
143, 129 ended by Ctrl-C, SIGTERM, SIGHUP.)";

struct Options {
    std::string name;
    ExperimentOptions experiment;
    bool quiet = false;
};

std::vector<std::string> names() {
    std::vector<std::string> result;
    for (const Experiment& e : experiments()) result.push_back(e.name);
    return result;
}

const Experiment& find(const std::string& name) {
    for (const Experiment& e : experiments())
        if (e.name == name) return e;
    throw InputError({}, fmt::format("unknown experiment '{}'; {}", name, valid_names(name, names())));
}

int run(Options options) {
    if (options.name.empty()) {
        for (const Experiment& e : experiments()) fmt::print("{:<22}{}\n", e.name, e.description);
        return exit_success;
    }
    const Experiment& experiment = find(options.name);
    if (options.experiment.folder.empty()) throw InputError({}, "-o is missing: the folder for the results");
    const std::filesystem::path folder(options.experiment.folder);
    std::filesystem::create_directories(folder);
    check_writable((folder / "results.json").string());
    options.experiment.command = command_line();
    options.experiment.program = version();

    ProgressLine line(options.quiet ? Verbosity::quiet : Verbosity::normal, "mutations");
    const InterruptGuard interrupt(!options.quiet);
    ExperimentCallbacks callbacks;
    callbacks.progress = [&line](const Progress& p) { line.show(p); };
    callbacks.warn = [&line](const std::string& message) { line.warn(message); };
    callbacks.stop = [&interrupt] { return interrupt.signal() != 0; };
    ExperimentResult result = experiment.run(options.experiment, callbacks);
    line.clear();
    if (!result.complete) {
        if (!options.quiet) fmt::print("interrupted\n");
        return exit_signal + interrupt.signal();
    }
    result.json["experiment"] = experiment.name;
    result.json["command"] = options.experiment.command;
    result.json["program"] = options.experiment.program;
    write_file((folder / "results.json").string(), result.json.dump(2) + "\n");
    write_file((folder / "picture.svg").string(), result.svg);
    if (!options.quiet) {
        fmt::print("{}", result.text);
        for (const char* name : {"results.json", "picture.svg"}) fmt::print("wrote {}\n", (folder / name).string());
    }
    return exit_success;
}

}  // namespace

void add_experiment_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = keyhole.add_subcommand("experiment", "Make an experiment of the papers again");
    command->add_option("NAME", options->name, "The experiment");
    ExperimentOptions& e = options->experiment;
    command->add_option("-o,--output", e.folder, "Folder for the results; made if it does not exist")
        ->option_text("DIR");
    command->add_option("--scenes", e.scenes, "Folder of the project's own scenes [default: scenes]")
        ->option_text("DIR");
    command->add_option("--scene", e.scene_files, "Another scene file for acceptance (repeatable)")
        ->option_text("FILE");
    add_integer(*command, "--runs", e.runs, 2, 100000, "Independent runs [default: the experiment's]");
    const auto seconds = [](double& value) {
        return [&value](const std::string& text) { value = parse_duration(text); };
    };
    add_parsed(*command, "-t,--time", "TIME", seconds(e.seconds),
               "CPU time of each render that is limited by time [default: 20s]");
    add_parsed(*command, "--reference-time", "TIME", seconds(e.reference_seconds),
               "Time for each reference [default: 10m, or 20 renders]");
    add_parsed(
        *command, "--scale", "NUMBER", [&e](const std::string& text) { e.scale = parse_real(text, 1e-6, 1); },
        "Of the numbers of samples, up to 1: less for a quick look [default: 1]");
    add_integer(*command, "--threads", e.threads, 1, 4096, "Threads [default: all processors]");
    add_parsed(
        *command, "--seed", "INTEGER", [&e](const std::string& text) { e.seed = parse_unsigned(text); },
        "From which all seeds are made [default: 0]");
    command->add_flag("-q,--quiet", options->quiet, "Print errors only");
    command->footer(footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
