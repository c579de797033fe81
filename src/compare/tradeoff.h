// What each knob does to speed and accuracy: of a comparison in which every entry but the first has one setting
// changed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace keyhole {

// `results` without its "tradeoff", which this returns (docs/results.schema.json): for each knob of the entries, in
// order, its settings with the time of a mutation, variance, squared bias and efficiency, and one line that follows
// from their figures. Settings without a finished run are left out. `base`: what the first entry has, by knob.
nlohmann::json make_tradeoff(const nlohmann::json& results, const nlohmann::json& base);

}  // namespace keyhole
