// `keyhole experiment`.
#include <gmock/gmock.h>

#include "harness.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

const std::string scenes = std::string(KEYHOLE_SOURCE_DIR) + "/scenes";

class ExperimentTest : public CommandTest {};

TEST_F(ExperimentTest, ListsWhatThereIsAndRefusesTheRest) {
    EXPECT_THAT(run({"experiment"}).out, HasSubstr("charted-toy"));
    const Finished unknown = run({"experiment", "charted-to", "-o", "out"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("did you mean 'charted-toy'?"));
    const Finished nowhere = run({"experiment", "charted-toy"});
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_THAT(nowhere.err, HasSubstr("-o is missing"));
    const Finished no_scenes = run({"experiment", "charted-toy", "-o", "out"});
    EXPECT_EQ(no_scenes.exit_code, 2);
    EXPECT_THAT(no_scenes.err, HasSubstr("scenes/charted-toy.xml"));
}

// Where failures depend on the state, leaving them out ends in a bias that is far above its error; the exact policies
// have none. Numbers of proposals: an eighth of the published ones.
TEST_F(ExperimentTest, OneDimensionShowsTheBiasOfExclusion) {
    const Finished done = run({"experiment", "proposal-failures-1d", "-o", "out", "--runs", "40", "--scale", "0.125"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(std::filesystem::exists(path("out/picture.svg")));
    const nlohmann::json models = json("out/results.json")["models"];
    for (const auto& model : models)
        for (const auto& entry : model["entries"]) {
            const auto& last = entry["points"].back();
            const double in_errors =
                last["squared_bias"].get<double>() / last["squared_bias_standard_error"].get<double>();
            if (model["name"] == "gaps" && entry["policy"] == "exclude")
                EXPECT_GT(in_errors, 20);
            else
                EXPECT_LT(std::abs(in_errors), 6) << model["name"] << ", " << entry["policy"];
        }
}

TEST_F(ExperimentTest, GeometryAwareStepsAreAcceptedMoreOften) {
    const Finished done = run({"experiment", "acceptance", "-o", "out", "-t", "0.3s", "--scenes", scenes});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json rows = json("out/results.json")["rows"];
    ASSERT_EQ(rows.size(), 18u);
    for (std::size_t i = 0; i < rows.size(); i += 3)
        EXPECT_GT(rows[i + 2]["perturbation_acceptance"].get<double>(),
                  1.5 * rows[i]["perturbation_acceptance"].get<double>())
            << rows[i]["scene"];
    EXPECT_TRUE(std::filesystem::exists(path("out/picture.svg")));
}

TEST_F(ExperimentTest, TheChartedToyRunsAtASmallScale) {
    const Finished done = run({"experiment", "charted-toy", "-o", "out", "--runs", "2", "--scale", "0.002",
                               "--reference-time", "1s", "--scenes", scenes});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json algorithms = json("out/results.json")["algorithms"];
    ASSERT_EQ(algorithms.size(), 6u);
    for (const auto& algorithm : algorithms) EXPECT_EQ(algorithm["points"].size(), 2u);
    EXPECT_TRUE(std::filesystem::exists(path("out/CMLT-128M.png")));
}

}  // namespace
}  // namespace keyhole
