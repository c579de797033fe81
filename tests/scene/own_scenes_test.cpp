// The project's own scenes: each loads without a word, needs what its description says, and together they cover every
// plugin of the reader.
#include "own_scenes.h"

#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

LoadedScene load(const std::string& name) { return read_scene((own_scenes_folder / (name + ".xml")).string()); }

class OwnScene : public testing::TestWithParam<std::string> {};

TEST_P(OwnScene, LoadsWithoutWarnings) {
    const LoadedScene loaded = load(GetParam());
    EXPECT_EQ(loaded.warnings, std::vector<std::string>{});
    EXPECT_EQ(loaded.unused, std::vector<std::string>{});
    EXPECT_FALSE(loaded.scene->emitters().empty());
    EXPECT_GT(loaded.scene->max_path_length(), 0);
}

TEST_P(OwnScene, IsDescribed) {
    const std::string text = text_of(own_scenes_folder / (GetParam() + ".xml"));
    EXPECT_EQ(text.rfind("<!-- ", 0), 0u) << "no comment at the top";
    EXPECT_LT(text.find("Hard: "), text.find("<scene ")) << "the comment does not say what is hard";
    EXPECT_NE(text_of(own_scenes_folder / "README.md").find("| `" + GetParam() + "` |"), std::string::npos);
}

// Lengths are metres, and so are the sizes of rooms and tables.
TEST_P(OwnScene, HasTheScaleOfARoom) {
    const double radius = load(GetParam()).scene->radius();
    EXPECT_GT(radius, 0.5);
    EXPECT_LT(radius, 20);
}

INSTANTIATE_TEST_SUITE_P(All, OwnScene, testing::ValuesIn(own_scene_names()),
                         [](const auto& test) { return test_name_of(test.param); });

TEST(OwnScenes, RequireWhatTheyAreMadeFor) {
    for (const std::string& name : own_scene_names()) {
        const auto loaded = load(name);
        const Requirements& needs = loaded.scene->requirements();
        EXPECT_EQ(needs.aperture, name == "stage") << name;
        EXPECT_EQ(needs.delta_emitters, name == "stage" || name == "blinds") << name;
        EXPECT_EQ(needs.environment,
                  name == "gallery" || name == "box-in-the-sun" || name == "blinds" || name == "veil")
            << name;
        // Path tracing finds no light from a delta emitter that a delta lobe passes on; no scene asks for that.
        EXPECT_FALSE(needs.delta_emitters && needs.bsdfs.delta) << name;
    }
}

TEST(OwnScenes, OfTheTransportTestsAreAllOfThem) {
    std::vector<std::string> names;
    for (const TransportCase& c : transport_cases()) names.push_back(c.scene);
    EXPECT_THAT(names, testing::UnorderedElementsAreArray(own_scene_names()));
}

void collect_plugins(const Element& element, std::set<std::string>& found) {
    if (const std::string* type = element.attribute("type")) found.insert(element.tag + " " + *type);
    for (const Element& child : element.children) collect_plugins(child, found);
}

// Those of the reader's own tables: a new plugin needs a scene.
TEST(OwnScenes, CoverEveryPlugin) {
    std::set<std::string> found;
    for (const TransportCase& c : transport_cases())
        collect_plugins(load_document((own_scenes_folder / (c.scene + ".xml")).string(), c.defines).scene, found);
    const auto expect_all = [&](const std::string& tag, const auto& plugins) {
        EXPECT_FALSE(plugins.empty()) << tag;
        for (const auto& plugin : plugins)
            EXPECT_TRUE(found.contains(tag + " " + plugin.type)) << tag << " " << plugin.type;
    };
    expect_all("bsdf", bsdf_plugins());
    expect_all("texture", texture_plugins());
    expect_all("shape", shape_plugins());
    expect_all("emitter", emitter_plugins());
    expect_all("sensor", sensor_plugins());
    expect_all("rfilter", filter_plugins());
}

TEST(OwnScenes, CoverTheModesOfPlugins) {
    std::string all;
    for (const TransportCase& c : transport_cases()) all += text_of(own_scenes_folder / (c.scene + ".xml"));
    for (const char* parameter :
         {"value=\"ggx\"", "value=\"beckmann\"", "\"alpha_u\"", "\"alpha_v\"", "value=\"nearest\"", "value=\"mirror\"",
          "value=\"clamp\"", "value=\"repeat\"", "\"to_uv\"", "\"nonlinear\"", "\"material\"", "\"fov_axis\"",
          "\"face_normals\"", "<include", "version=\"0.5.0\"", "version=\"3.0.0\""})
        EXPECT_NE(all.find(parameter), std::string::npos) << parameter;
}

}  // namespace
}  // namespace keyhole
