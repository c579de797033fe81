// The project's own scenes: each loads without a word, needs what its description says, and together they cover every
// plugin of the reader.
#include "own_scenes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

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

TEST(OwnScenes, CoverEveryPlugin) {
    std::string all;
    for (const std::string& name : own_scene_names()) all += text_of(own_scenes_folder / (name + ".xml"));
    for (const char* kind : {"bsdf:diffuse",
                             "bsdf:conductor",
                             "bsdf:roughconductor",
                             "bsdf:dielectric",
                             "bsdf:thindielectric",
                             "bsdf:roughdielectric",
                             "bsdf:plastic",
                             "bsdf:roughplastic",
                             "bsdf:phong",
                             "bsdf:mask",
                             "bsdf:twosided",
                             "bsdf:bumpmap",
                             "bsdf:null",
                             "bsdf:blendbsdf",
                             "emitter:area",
                             "emitter:point",
                             "emitter:spot",
                             "emitter:directional",
                             "emitter:constant",
                             "emitter:envmap",
                             "sensor:perspective",
                             "sensor:thinlens",
                             "sensor:orthographic",
                             "texture:bitmap",
                             "texture:checkerboard",
                             "shape:obj",
                             "shape:ply",
                             "shape:serialized",
                             "shape:rectangle",
                             "shape:cube",
                             "shape:sphere",
                             "shape:disk",
                             "shape:cylinder",
                             "shape:shapegroup",
                             "shape:instance",
                             "rfilter:box",
                             "rfilter:tent",
                             "rfilter:gaussian"}) {
        const std::string text = kind;
        const auto colon = text.find(':');
        EXPECT_NE(all.find("<" + text.substr(0, colon) + " type=\"" + text.substr(colon + 1) + "\""), std::string::npos)
            << text;
    }
    for (const char* parameter :
         {"value=\"ggx\"", "value=\"beckmann\"", "\"alpha_u\"", "\"alpha_v\"", "value=\"nearest\"", "value=\"mirror\"",
          "value=\"clamp\"", "value=\"repeat\"", "\"to_uv\"", "\"nonlinear\"", "\"material\"", "\"fov_axis\"",
          "\"face_normals\"", "<include", "version=\"0.5.0\"", "version=\"3.0.0\""})
        EXPECT_NE(all.find(parameter), std::string::npos) << parameter;
}

}  // namespace
}  // namespace keyhole
