#include "compare/warnings.h"

#include <gmock/gmock.h>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

RunRecord run_with(std::vector<std::string> warnings) {
    RunRecord run;
    run.statistics.warnings = std::move(warnings);
    return run;
}

TEST(Warnings, AreListedOnceWhateverTheirFigures) {
    const std::vector<RunRecord> runs = {run_with({"found by 12 paths, which carry 3.5e-05 of it", "no portals"}),
                                         run_with({"found by 7 paths, which carry 0.25 of it", "no portals"}),
                                         run_with({"no portals"}),
                                         run_with({"found by 7 paths, which carry 1e+03 of it", "biased by 5%"})};
    EXPECT_THAT(warnings_of(runs),
                ElementsAre("biased by 5% (1 of 4 runs)",
                            "found by 12 paths, which carry 3.5e-05 of it (3 of 4 runs; figures of the first)",
                            "no portals (3 of 4 runs)"));
}

TEST(Warnings, OfASingleRunAreAsTheyAre) {
    EXPECT_THAT(warnings_of(std::vector{run_with({"found by 12 paths"})}), ElementsAre("found by 12 paths"));
    EXPECT_THAT(warnings_of(std::vector{run_with({})}), IsEmpty());
}

}  // namespace
}  // namespace keyhole
