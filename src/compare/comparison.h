// Renders a scene in several ways, again and again, at equal cost, and says which way is how good.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/reference.h"
#include "render/render.h"

namespace keyhole {

// What all entries get the same amount of in each run.
enum class EqualCost { time, cpu, mutations };
std::string name_of(EqualCost cost);  // as in results.json

struct VariedParameter {
    std::string name;  // a key of the mix
    double value = 0;
};

// `keyhole tradeoff`: which knob is not as in the first entry.
struct KnobSetting {
    std::string name, value;
};

// One way to render: a mix, or an integrator.
struct ComparedEntry {
    std::string name;  // unique in the comparison
    Integrator integrator = Integrator::mmlt;
    Mix mix;                                         // for path and bdpt its lengths only
    std::optional<VariedParameter> parameter;        // of a sweep
    std::optional<KnobSetting> knob = std::nullopt;  // of a trade-off
    const Scene* scene = nullptr;                    // the same scene, with other ray queries; null: the comparison's
};

struct ComparisonPlan {
    std::string folder;
    std::vector<ComparedEntry> entries;
    EqualCost equal = EqualCost::time;
    double budget = 60;  // of each run: seconds, CPU-seconds of all threads, or mutations (samples) per pixel
    int runs = 10;       // of each entry
    int threads = 0;     // 0: all
    std::uint64_t seed = 0;
    std::string reference_file;  // empty: made by an integrator, in the folder
    Integrator reference_integrator = Integrator::bdpt;
    double reference_seconds = 600;
    bool discard = false;  // runs in the folder that are of something else, in place of refusing to go on

    std::map<std::string, std::string> knobs;  // what the first entry has, by name; of a trade-off

    // For the results.
    std::string scene_file, scene_name, command, program;
};

struct ComparisonCallbacks {
    std::function<void(const Progress&)> progress;  // of the comparison as a whole
    std::function<bool()> stop;                     // true: end the run at hand, write results, and return
    std::function<void(const std::string&)> warn;
    // Metadata of a run's image, given the settings it was made with.
    std::function<std::map<std::string, std::string>(const RenderSettings&, const RenderStatistics&)> describe;
};

struct ComparisonOutcome {
    nlohmann::json results;  // docs/results.schema.json
    bool complete = false;   // all runs are there
};

// Makes the reference if there is none, then the runs that the folder does not hold yet: one run of each entry after
// the other, again and again, so that a noisy machine hurts all alike. Writes results.json and index.html into the
// folder every now and then, and at the end.
//
// A run that is stopped is lost; all others are kept. Throws InputError if runs in the folder are of another scene,
// mix, program, budget or number of threads (without `discard`), if two entries have one name, and as resolve() does.
ComparisonOutcome run_comparison(const Scene& scene, ComparisonPlan plan, const ComparisonCallbacks& callbacks);

}  // namespace keyhole
