// The strategies that a mix may hold, by name. To add one: write it in a file of its own, and give it an entry here.
// Mix files, `keyhole mixes strategies` and docs/mix-files.md know it from that entry.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chain/rectification.h"
#include "strategies/inverse_small_step.h"
#include "strategies/parameter.h"
#include "strategies/path_lengths.h"

namespace keyhole {

class StepSize;

// What a strategy is made from, for one thread. Must outlive it.
struct StrategyContext {
    Evaluator& evaluator;
    ChartEvaluator* charts;  // the same, or null where states are not of one technique each
    const TechniqueDistribution& techniques;
    PathLengths lengths;  // resolved: max > 0
    RectificationSettings rectification;
};

struct StrategyInfo {
    std::string name;         // kebab-case
    std::string description;  // one line
    std::vector<Parameter> parameters;

    bool ergodic = false;  // from every path, it alone can reach every path (of the chain's length, where it is fixed)
    bool independent = false;  // its proposals do not depend on the state, and are estimates of b
    bool all_at_once = false;  // also moves states of all techniques at once
    StateNeeds needs;

    // Why it can never move a chain in this scene, among these lengths (resolved); empty: it can.
    std::string (*hindrance)(const Scene&, const PathLengths&);
    // What is wrong with values that are each valid alone; empty: nothing. May be null.
    std::string (*contradiction)(const Values&) = nullptr;
    std::unique_ptr<PssStrategy> (*make)(const StrategyContext&, const Values&);
    // What makes the sizes of its steps, where these are the cones about edges; else null.
    std::unique_ptr<const StepSize> (*cones)(const Scene&, const Values&) = nullptr;
};

// In the order of the documentation.
const std::vector<StrategyInfo>& strategy_registry();

// Throws InputError (without a location) that lists the valid names.
const StrategyInfo& find_strategy(const std::string& name);

}  // namespace keyhole
