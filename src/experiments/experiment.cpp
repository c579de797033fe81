#include "experiments/experiment.h"

namespace keyhole {

std::span<const Experiment> experiments() {
    static const Experiment list[] = {
        {"charted-toy", "Six ways to sample direct light through obstacles [Pantaleoni 2017, section 7.1, table 1]",
         run_charted_toy},
        {"proposal-failures-1d",
         "A normal distribution with failing proposals [Zeng et al. 2019, table 2, figure 3], and one whose failures "
         "depend on the state",
         run_proposal_failures_1d},
        {"proposal-failures", "MMLT with each policy for failing proposals on three scenes: error over time",
         run_proposal_failures},
        {"acceptance",
         "Acceptance of perturbations, with steps of one size and as large as empty cones [Otsu et al. 2018, table 1]",
         run_acceptance}};
    return list;
}

}  // namespace keyhole
