// The results of a comparison, from the runs in its folder.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compare/comparison.h"
#include "compare/run_store.h"

namespace keyhole {

// The content of results.json (docs/results.schema.json). `stores`: of the plan's entries, in their order; `runs`: how
// many of each are complete, from run 1 on.
nlohmann::json make_results(const Scene& scene, const ComparisonPlan& plan, const Reference& reference,
                            const std::vector<RunStore>& stores, const std::vector<int>& runs);

}  // namespace keyhole
