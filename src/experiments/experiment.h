// The papers' own experiments, made again.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "render/render.h"

namespace keyhole {

struct ExperimentOptions {
    std::string folder;                    // exists; for what the experiment keeps beside its results
    std::string scenes = "scenes";         // the folder of the project's own scenes
    std::vector<std::string> scene_files;  // more scenes, where the experiment takes any
    int runs = 0;                          // 0: the experiment's default
    double seconds = 0;                    // of each render that is limited by time; 0: the experiment's default
    double reference_seconds = 0;
    double scale = 1;  // of the numbers of samples: below 1 for a quick look
    int threads = 0;
    std::uint64_t seed = 0;
    std::string command, program;  // for the results
};

struct ExperimentCallbacks {
    std::function<void(const Progress&)> progress;
    std::function<void(const std::string&)> warn;
    std::function<bool()> stop;
};

struct ExperimentResult {
    nlohmann::json json;
    std::string svg;
    std::string text;  // a table and what it says
    bool complete = true;
};

struct Experiment {
    const char* name;
    const char* description;  // one line
    ExperimentResult (*run)(const ExperimentOptions&, const ExperimentCallbacks&);
};

std::span<const Experiment> experiments();

ExperimentResult run_proposal_failures_1d(const ExperimentOptions& options, const ExperimentCallbacks& callbacks);
ExperimentResult run_charted_toy(const ExperimentOptions& options, const ExperimentCallbacks& callbacks);
ExperimentResult run_acceptance(const ExperimentOptions& options, const ExperimentCallbacks& callbacks);
ExperimentResult run_proposal_failures(const ExperimentOptions& options, const ExperimentCallbacks& callbacks);

}  // namespace keyhole
