// `keyhole roundtrip`.
#include <gmock/gmock.h>

#include "harness.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

class RoundTrip : public CommandTest {
  protected:
    RoundTrip() { write("room.xml", room_scene); }
};

TEST_F(RoundTrip, SaysHowExactTheInversesAre) {
    const Finished done = run({"roundtrip", "room.xml", "--paths", "2000", "--json"});
    EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
    const nlohmann::json result = nlohmann::json::parse(done.out);
    EXPECT_EQ(result["paths"], 2000);
    EXPECT_EQ(result["within_bounds"], true);
    EXPECT_GT(result["inversions"], 2000);
    for (const auto& sampler : result["samplers"]) EXPECT_LT(sampler["worst"], 1e-3) << sampler;
    const Finished table = run({"roundtrip", "room.xml", "--paths", "2000"});
    for (const char* text : {"sensor perspective", "emitter area", "p-value"}) EXPECT_THAT(table.out, HasSubstr(text));
}

TEST_F(RoundTrip, RefusesWhatMakesNoSense) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"roundtrip", "room.xml", "--max-length", "1"}, {"roundtrip", "room.xml", "--paths", "0"}, {"roundtrip"}})
        EXPECT_EQ(run(arguments).exit_code, 2);
}

}  // namespace
}  // namespace keyhole
