// The warnings of several runs, as a page lists them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compare/run_store.h"

namespace keyhole {

// Each warning once, as the first run gave it, with the number of runs that gave it, be it with other figures. Of a
// single run as they are.
std::vector<std::string> warnings_of(std::span<const RunRecord> runs);

}  // namespace keyhole
