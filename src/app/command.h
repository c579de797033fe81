// The subcommands of `keyhole`. One file each; each declares its options and what is run once all options are valid.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace keyhole {

// Documented in the help text, docs/command.md and nowhere else.
enum ExitCode {
    exit_success = 0,
    exit_failure = 1,    // something went wrong while running: a file that cannot be written, too little memory
    exit_bad_input = 2,  // options, scenes and images that are not valid
    exit_signal = 128,   // plus the number of the signal: 130 for Ctrl-C, 143 for SIGTERM
};

// What the chosen subcommand does; its result is the exit code.
using Runner = std::function<int()>;

void add_render_command(CLI::App& keyhole, Runner& runner);
void add_diff_command(CLI::App& keyhole, Runner& runner);
void add_info_command(CLI::App& keyhole, Runner& runner);
void add_bench_command(CLI::App& keyhole, Runner& runner);
void add_mixes_command(CLI::App& keyhole, Runner& runner);
void add_compare_command(CLI::App& keyhole, Runner& runner);
void add_sweep_command(CLI::App& keyhole, Runner& runner);
void add_tradeoff_command(CLI::App& keyhole, Runner& runner);
void add_roundtrip_command(CLI::App& keyhole, Runner& runner);
void add_portals_command(CLI::App& keyhole, Runner& runner);
void add_cones_command(CLI::App& keyhole, Runner& runner);
void add_trace_command(CLI::App& keyhole, Runner& runner);
void add_experiment_command(CLI::App& keyhole, Runner& runner);

}  // namespace keyhole
