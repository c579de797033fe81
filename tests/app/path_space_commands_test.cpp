// `keyhole cones`, `keyhole trace` and `keyhole portals`.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "harness.h"
#include "render/image.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

const std::string scenes = std::string(KEYHOLE_SOURCE_DIR) + "/scenes/";

std::string text_of(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

class PathSpaceCommands : public CommandTest {};

TEST_F(PathSpaceCommands, ConesAreAnImageOfAngles) {
    for (const std::string estimator : {"fast", "bvh-cut", "exact"}) {
        const Finished done = run(
            {"cones", scenes + "ajar-door.xml", "--size", "40x25", "--estimator", estimator, "-o", estimator + ".exr"});
        ASSERT_EQ(done.exit_code, 0) << done.err;
        EXPECT_THAT(done.out, HasSubstr("/ exact: mean"));
        const Image image = read_image(path(estimator + ".exr"));
        ASSERT_EQ(image.width, 40);
        for (const float angle : image.rgb) {
            EXPECT_GE(angle, 0.0099F);
            EXPECT_LE(angle, 0.5001F);
        }
    }
    EXPECT_EQ(run({"cones", scenes + "charted-toy.xml", "-o", "no.exr"}).exit_code, 2) << "orthographic";
    EXPECT_EQ(run({"cones", scenes + "ajar-door.xml", "--estimator", "slow"}).exit_code, 2);
}

TEST_F(PathSpaceCommands, TraceDrawsAChain) {
    const Finished done = run({"trace", scenes + "three-planes.xml", "-D", "hole=0.2", "--mix", "portal", "-n", "300"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("of 300 mutations accepted"));
    EXPECT_THAT(text_of(path("trace.svg")), HasSubstr("x over 300 mutations"));
    EXPECT_EQ(run({"trace", scenes + "three-planes.xml", "--mix", "portl"}).exit_code, 2);
}

TEST_F(PathSpaceCommands, PortalsAreFoundAndUsed) {
    const Finished found = run({"portals", scenes + "box-in-the-sun.xml", "-o", "found.xml"});
    ASSERT_EQ(found.exit_code, 0) << found.err;
    EXPECT_THAT(found.out, HasSubstr("portal-1"));
    const Finished used = run({"render", scenes + "cornell-box.xml", "--portals", "found.xml", "--mix", "portal", "-n",
                               "8", "--size", "16x16", "-o", "used.exr"});
    EXPECT_EQ(used.exit_code, 0) << used.err;
    EXPECT_EQ(used.err.find("never applies"), std::string::npos) << used.err;
    // The image says where its portals are from, and can be made again.
    const Finished again = run({"render", "--like", "used.exr", "-o", "again.exr"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_image(path("used.exr")).rgb, read_image(path("again.exr")).rgb);
}

}  // namespace
}  // namespace keyhole
