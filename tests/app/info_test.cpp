// `keyhole info`
#include <gmock/gmock.h>

#include "harness.h"

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class InfoCommand : public CommandTest {
  protected:
    InfoCommand() { write("room.xml", room_scene); }
};

TEST_F(InfoCommand, JsonSaysWhatTheSceneHoldsAndRequires) {
    const Finished done = run({"info", "room.xml", "--json"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const nlohmann::json json = nlohmann::json::parse(done.out);
    EXPECT_EQ(json["shapes"]["shapes"], 4);
    EXPECT_EQ(json["emitters"]["count"], 1);
    EXPECT_EQ(json["emitters"]["kinds"]["area"], 1);
    EXPECT_EQ(json["sensor"], "perspective");
    EXPECT_EQ(json["film"]["width"], 16);
    EXPECT_EQ(json["film"]["filter"], "box");
    EXPECT_EQ(json["max_length"], 5);
    EXPECT_EQ(json["hash"].get<std::string>().size(), 16u);
    EXPECT_GT(json["bounding_sphere"]["radius"], 1);
    const nlohmann::json& needs = json["requires"];
    EXPECT_EQ(needs["delta_lobes"], true);
    EXPECT_EQ(needs["smooth_lobes"], true);
    EXPECT_EQ(needs["transmission"], true);
    for (const char* name :
         {"finite_aperture", "environment", "infinite_emitters", "delta_emitters", "textures", "tangents"})
        EXPECT_EQ(needs[name], false) << name;
    EXPECT_TRUE(json["unused"].empty());
    EXPECT_THAT(files(), ElementsAre("room.xml"));
}

TEST_F(InfoCommand, TextIsForPeople) {
    std::string scene = room_scene;
    scene.insert(scene.find("  <shape type=\"cube\">"), "  <bsdf type=\"diffuse\" id=\"forgotten\"/>\n");
    write("room.xml", scene);
    const Finished done = run({"info", "room.xml", "--size", "32x20"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    for (const char* text : {"1 area", "perspective", "film 32x20", "up to 5 edges", "requires",
                             "delta_lobes        yes", "finite_aperture    no", "unused", "forgotten"})
        EXPECT_THAT(done.out, HasSubstr(text));
}

}  // namespace
}  // namespace keyhole
