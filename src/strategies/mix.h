// A strategy mix: everything that says how the chains of a render move. Its file format: mix_file.h, docs/mix-files.md.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/spectrum.h"
#include "strategies/registry.h"

namespace keyhole {

// How many vertices from the light the techniques in use may have.
enum class LightVertices { any, at_most_one, one, none };

// Which techniques there are and what a state holds of them.
struct TechniqueChoice {
    LightVertices light_vertices = LightVertices::any;
    bool all_at_once = false;  // a state is a bundle of paths by all techniques [Kelemen et al. 2002], not one path
    Weighting weighting = Weighting::target;

    TechniqueSet set() const;
    bool operator==(const TechniqueChoice&) const = default;
};

struct MixStrategy {
    const StrategyInfo* info = nullptr;  // an entry of the registry
    std::string label;                   // in statistics and --set; by default the strategy's name
    double weight = 1;                   // relative to the others; 0: not used
    Values parameters;                   // all of them; those without effect are at their defaults

    bool operator==(const MixStrategy&) const = default;
};

// Integers that are 0 are left to the program.
struct Mix {
    std::string name, description;
    TargetFunction target = TargetFunction::luminance;
    RectificationSettings rectification;
    std::uint64_t seed = 0;  // < 2^63, as TOML has no greater integers
    PathLengths lengths;
    TechniqueChoice techniques;
    int chain_count = 0;
    int exchange_every = 0;         // mutations between exchanges of paths between chains; 0: never
    std::int64_t chain_length = 0;  // mutations of each chain, where the render is given neither a time nor a number
    std::int64_t bootstrap_samples = 0;
    double most_starts = 1;  // largest share of the chains that start from one of them
    // Whether the render first finds out which of the strategies to use, how often, and with which sizes
    // (render/race.h).
    enum class Tuning { off, race } tuning = Tuning::off;
    std::vector<MixStrategy> strategies;

    bool operator==(const Mix&) const = default;
};

// A key of a mix file outside of its strategies.
struct MixField {
    std::string section;  // the TOML table; empty: the file's head
    Parameter parameter;
    std::function<Value(const Mix&)> get;
    std::function<void(Mix&, const Value&)> set;  // `checked` values

    std::string key() const { return section.empty() ? parameter.name : section + "." + parameter.name; }
};
const std::vector<MixField>& mix_fields();
// Whether the field that this one needs has the needed value.
bool has_effect(const MixField& field, const Mix& mix);

// The key of a strategy's weight, beside its parameters.
const Parameter& weight_parameter();

// Sets a key to a value written as on the command line: "seed", "chains.count", "small-step.sigma", "LABEL.weight".
// Throws InputError (without a location) that says what would have been valid.
void set_value(Mix& mix, const std::string& key, const std::string& text);

// Puts parameters without effect back to their defaults. What is wrong with the strategy's parameters; empty: nothing.
std::string settle(MixStrategy& strategy);
// Multiplies the sizes of the strategy's steps, within what is valid. False where nothing changes or the result is not
// valid.
bool scale_steps(MixStrategy& strategy, double factor);
// The same of the fields outside of strategies.
void settle_fields(Mix& mix);

// What is wrong with a mix as a whole: no strategies or weights, nothing that reaches every path, two strategies that
// are the same, lengths, techniques.
struct Contradiction {
    std::string key;  // what it is about, as for set_value; "strategy" for all of them
    std::string message;
};
std::optional<Contradiction> contradiction(const Mix& mix);

// Sets keys in order and checks the result. Throws InputError, prefixed with the key that is wrong.
struct Setting {
    std::string key, text;
    std::string origin;  // what the user wrote, for errors: "--set", "--seed"
};
void apply_settings(Mix& mix, const std::vector<Setting>& settings);

}  // namespace keyhole
