// What `keyhole compare` and `keyhole sweep` have in common: options, and what is done with them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/mix_options.h"
#include "app/options.h"
#include "compare/comparison.h"
#include "strategies/mix.h"

namespace keyhole {

struct ComparisonOptions {
    SceneOptions scene;
    MixOptions mix;  // its settings are of all mixes: --set, --max-length, ...; its name is for sweeps
    double time = 0, mutations = 0;
    std::string equal;  // empty: time, or mutations where their number is given
    double reference_time = 0;
    ComparisonPlan plan;
    bool quiet = false, verbose = false;
};

// All but what says which entries there are. `options` must live until the command line has been parsed.
void add_comparison_options(CLI::App& command, ComparisonOptions& options);

// Runs the comparison of `entries` and prints its results. The settings have been applied to the entries' mixes.
// Returns the exit code.
int run_comparison_command(ComparisonOptions options, std::vector<ComparedEntry> entries);

// The same for entries that depend on the scene: make(loaded, plan) gives them, and may complete the plan.
using MakeEntries = std::function<std::vector<ComparedEntry>(const LoadedScene& loaded, ComparisonPlan& plan)>;
int run_comparison_command(ComparisonOptions options, const std::string& command, const MakeEntries& make);

// Path or bdpt, with the lengths that the settings say.
ComparedEntry integrator_entry(const ComparisonOptions& options, Integrator integrator);

// The part of the help text on files, resuming and exit codes.
extern const char* const comparison_footer;

}  // namespace keyhole
