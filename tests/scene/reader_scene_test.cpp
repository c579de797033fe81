// Whole scenes: what the reader builds of them.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene_fingerprint.h"
#include "scene_text.h"

namespace keyhole {
namespace {

using test::fingerprint;
using test::Folder;
using test::scene_with;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

void write_picture(const std::string& filename) {
    const unsigned char pixels[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 200, 200, 200};
    auto file = OIIO::ImageOutput::create(filename);
    ASSERT_TRUE(file && file->open(filename, OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(file->write_image(OIIO::TypeDesc::UINT8, pixels));
    ASSERT_TRUE(file->close());
}

LoadedScene read(const Folder& folder, const std::string& text, const ReaderOptions& options = {}) {
    return read_scene(folder.write("scene.xml", text), options);
}

// All that has two spellings, in the dialect of Mitsuba 0.6 ...
const char* old_dialect = R"(<scene version="0.6.0">
<integrator type="path"><integer name="maxDepth" value="7"/><integer name="rrDepth" value="3"/></integrator>
<sensor type="thinlens">
    <float name="fov" value="50"/><string name="fovAxis" value="smaller"/>
    <float name="nearClip" value="0.1"/><float name="farClip" value="100"/>
    <float name="apertureRadius" value="0.01"/><float name="focusDistance" value="4"/>
    <float name="principalPointOffsetX" value="0.02"/>
    <transform name="toWorld"><lookAt origin="0, 1, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="ldsampler"><integer name="sampleCount" value="4"/></sampler>
    <film type="ldrfilm"><integer name="width" value="64"/><integer name="height" value="48"/>
        <integer name="cropOffsetX" value="4"/><integer name="cropOffsetY" value="5"/>
        <integer name="cropWidth" value="40"/><integer name="cropHeight" value="30"/>
        <string name="fileFormat" value="png"/><rfilter type="tent"/></film>
</sensor>
<bsdf type="twosided" id="metal"><bsdf type="roughconductor">
    <string name="distribution" value="ggx"/><float name="alphaU" value="0.2"/><float name="alphaV" value="0.4"/>
    <string name="material" value="Au"/><spectrum name="specularReflectance" value="0.9"/>
</bsdf></bsdf>
<bsdf type="roughdielectric" id="glass"><float name="intIOR" value="1.4"/><string name="extIOR" value="water"/></bsdf>
<bsdf type="roughplastic" id="paint"><texture name="diffuseReflectance" type="bitmap">
    <string name="filename" value="two by two.png"/><string name="filterType" value="nearest"/>
    <string name="wrapMode" value="mirror"/>
    <float name="uscale" value="3"/><float name="vscale" value="2"/><float name="uoffset" value="0.25"/></texture></bsdf>
<shape type="rectangle"><transform name="toWorld"><scale value="3"/><rotate x="1" angle="-90"/><translate y="-1"/></transform>
    <boolean name="flipNormals" value="true"/><ref id="metal"/></shape>
<shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="-1"/><ref id="glass"/></shape>
<shape type="cube"><transform name="toWorld"><scale value="0.4"/><translate x="0.8"/></transform><ref id="paint"/></shape>
<emitter type="spot"><transform name="toWorld"><lookAt origin="0, 3, 0" target="0, 0, 0" up="1, 0, 0"/></transform>
    <rgb name="intensity" value="3, 2, 1"/><float name="cutoffAngle" value="30"/><float name="beamWidth" value="10"/></emitter>
</scene>)";

// ... and of Mitsuba 3.
const char* new_dialect = R"(<scene version="3.5.0">
<integrator type="path"><integer name="max_depth" value="7"/><integer name="rr_depth" value="3"/></integrator>
<sensor type="thinlens">
    <float name="fov" value="50"/><string name="fov_axis" value="smaller"/>
    <float name="near_clip" value="0.1"/><float name="far_clip" value="100"/>
    <float name="aperture_radius" value="0.01"/><float name="focus_distance" value="4"/>
    <float name="principal_point_offset_x" value="0.02"/>
    <transform name="to_world"><lookat origin="0, 1, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="multijitter"><integer name="sample_count" value="4"/></sampler>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/>
        <integer name="crop_offset_x" value="4"/><integer name="crop_offset_y" value="5"/>
        <integer name="crop_width" value="40"/><integer name="crop_height" value="30"/>
        <string name="file_format" value="openexr"/><rfilter type="tent"/></film>
</sensor>
<bsdf type="roughconductor" id="inner">
    <string name="distribution" value="ggx"/><float name="alpha_u" value="0.2"/><float name="alpha_v" value="0.4"/>
    <string name="material" value="Au"/><float name="specular_reflectance" value="0.9"/></bsdf>
<bsdf type="twosided" id="metal"><ref id="inner"/></bsdf>
<bsdf type="roughdielectric" id="glass"><float name="int_ior" value="1.4"/><float name="ext_ior" value="1.3330"/></bsdf>
<texture type="bitmap" id="picture">
    <string name="filename" value="two by two.png"/><string name="filter_type" value="nearest"/>
    <string name="wrap_mode" value="mirror"/>
    <transform name="to_uv"><scale x="3" y="2"/><translate x="0.25"/></transform></texture>
<bsdf type="roughplastic" id="paint"><ref name="diffuse_reflectance" id="picture"/></bsdf>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate value="1, 0, 0" angle="-90"/>
    <translate value="0, -1, 0"/></transform><boolean name="flip_normals" value="true"/><ref id="metal"/></shape>
<shape type="sphere"><float name="radius" value="0.5"/><point name="center" value="-1, 0, 0"/><ref id="glass"/></shape>
<shape type="cube"><transform name="to_world"><scale value="0.4"/><translate x="0.8"/></transform><ref id="paint"/></shape>
<emitter type="spot"><transform name="to_world"><lookat origin="0, 3, 0" target="0, 0, 0" up="1, 0, 0"/></transform>
    <rgb name="intensity" value="3, 2, 1"/><float name="cutoff_angle" value="30"/><float name="beam_width" value="10"/></emitter>
</scene>)";

TEST(ReaderScene, BothDialectsGiveTheSameScene) {
    const Folder folder;
    write_picture(folder.path("two by two.png"));
    const LoadedScene a = read(folder, old_dialect), b = read(folder, new_dialect);
    const auto of_a = fingerprint(*a.scene), of_b = fingerprint(*b.scene);
    EXPECT_GT(of_a.size(), 10000u) << "the sensor does not see the shapes";
    EXPECT_EQ(of_a, of_b);
    EXPECT_EQ(a.scene->max_path_length(), 7);
    EXPECT_THAT(a.warnings, IsEmpty());
    EXPECT_THAT(a.unused, Contains(HasSubstr("sampler 'ldsampler' has no effect")));
    EXPECT_THAT(a.unused, Contains(HasSubstr("parameter 'rr_depth' of integrator 'path' has no effect")));
    EXPECT_NE(a.scene->content_hash(), b.scene->content_hash());
}

TEST(ReaderScene, ADialectIsNotEnforced) {
    const Folder folder;
    write_picture(folder.path("two by two.png"));
    std::string mixed = old_dialect;
    mixed.replace(mixed.find("0.6.0"), 5, "3.0.0");
    EXPECT_EQ(fingerprint(*read(folder, mixed).scene), fingerprint(*read(folder, old_dialect).scene));
}

TEST(ReaderScene, ConductorsDefaultToTheMaterialOfTheDialect) {
    const Folder folder;
    const auto with = [&](const char* version, const char* material) {
        return fingerprint(*read(folder, std::string("<scene version=\"") + version + R"(">
            <sensor type="perspective"><transform name="to_world"><translate z="-3"/></transform></sensor>
            <shape type="sphere"><bsdf type="conductor">)" +
                                             material + "</bsdf></shape></scene>")
                                .scene);
    };
    EXPECT_EQ(with("0.6.0", ""), with("3.0.0", R"(<string name="material" value="Cu"/>)"));
    EXPECT_EQ(with("3.0.0", ""), with("0.6.0", R"(<string name="material" value="none"/>)"));
    EXPECT_NE(with("3.0.0", ""), with("0.6.0", ""));
}

TEST(ReaderScene, TheDefaultsAreMitsubas) {
    const Folder folder;
    const LoadedScene s = read(folder, scene_with(""));
    const FilmSettings& film = s.scene->film();
    EXPECT_EQ(film.width, 768);
    EXPECT_EQ(film.height, 576);
    EXPECT_STREQ(film.filter.name(), "gaussian");
    EXPECT_EQ(film.filter.radius, 2);
    EXPECT_EQ(s.scene->max_path_length(), 0);
    EXPECT_EQ(fingerprint(*s.scene),
              fingerprint(*read(folder,
                                "<scene version=\"3.0.0\"><sensor type=\"perspective\">"
                                "<string name=\"focal_length\" value=\"50mm\"/></sensor></scene>")
                               .scene));
}

TEST(ReaderScene, TheCommandLineReplacesTheFilm) {
    const Folder folder;
    write_picture(folder.path("two by two.png"));
    ReaderOptions options;
    options.width = 128;
    options.height = 96;
    const LoadedScene larger = read(folder, old_dialect, options);
    EXPECT_EQ(larger.scene->film().width, 128);
    EXPECT_EQ(larger.scene->film().crop_width, 128);
    EXPECT_THAT(larger.warnings, Contains(HasSubstr("crop window is ignored")));
    // The same view: the middle of the film sees along the same ray.
    const auto middle = [](const Scene& scene) {
        const Vec2 raster(0.5 * scene.film().width, 0.5 * scene.film().height);
        return scene.sensor().ray(scene.sensor().sample_point({0.5, 0.5}), raster).d;
    };
    EXPECT_LT((middle(*larger.scene) - middle(*read(folder, old_dialect).scene)).norm(), 1e-12);

    options = {};
    options.override_crop = true;
    options.crop_x = 1;
    options.crop_y = 2;
    options.crop_width = 3;
    options.crop_height = 4;
    const FilmSettings film = read(folder, old_dialect, options).scene->film();
    EXPECT_EQ(film.width, 64);
    EXPECT_EQ(film.crop_x, 1);
    EXPECT_EQ(film.crop_height, 4);
    options.crop_width = 64;
    EXPECT_THROW(read(folder, old_dialect, options), InputError);
    options = {};
    options.width = 100000;
    EXPECT_THROW(read(folder, old_dialect, options), InputError);
}

TEST(ReaderScene, VariablesReachTheScene) {
    const Folder folder;
    const std::string text =
        "<scene version=\"3.0.0\"><default name=\"depth\" value=\"5\"/><default name=\"spare\" value=\"1\"/>"
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"$depth\"/></integrator>"
        "<sensor type=\"perspective\"/></scene>";
    ReaderOptions options;
    EXPECT_EQ(read(folder, text).scene->max_path_length(), 5);
    EXPECT_THAT(read(folder, text).unused, Contains(HasSubstr("default 'spare'")));
    options.defines["depth"] = "-1";
    EXPECT_EQ(read(folder, text, options).scene->max_path_length(), -1);
    options.defines["dept"] = "3";
    EXPECT_THROW(read(folder, text, options), InputError);
}

TEST(ReaderScene, LenientTurnsUnknownParametersIntoWarnings) {
    const Folder folder;
    const std::string text = scene_with("<bsdf type=\"diffuse\"><float name=\"shine\" value=\"1\"/></bsdf>");
    EXPECT_THROW(read(folder, text), InputError);
    ReaderOptions options;
    options.lenient = true;
    EXPECT_THAT(read(folder, text, options).warnings,
                Contains(HasSubstr(":3:22: unknown parameter 'shine' of bsdf 'diffuse'; valid names: reflectance")));
    EXPECT_THROW(read(folder, scene_with("<bsdf type=\"difuse\"/>"), options), InputError);
    EXPECT_THROW(
        read(folder, scene_with("<bsdf type=\"plastic\"><float name=\"int_ior\" value=\"x\"/></bsdf>"), options),
        InputError);
}

TEST(ReaderScene, SaysWhatIsNotReferredTo) {
    const Folder folder;
    const LoadedScene s =
        read(folder, scene_with("<bsdf type=\"diffuse\" id=\"spare\"/><bsdf type=\"diffuse\" id=\"in use\"/>"
                                "<texture type=\"checkerboard\" id=\"check\"/>"
                                "<shape type=\"cube\"><ref id=\"in use\"/></shape>"));
    EXPECT_THAT(s.unused, Contains(HasSubstr("bsdf 'spare' is not referred to (")));
    EXPECT_THAT(s.unused, Contains(HasSubstr("texture 'check' is not referred to (")));
    EXPECT_EQ(s.unused.size(), 2u);
}

TEST(ReaderScene, AMeshFileIsReadOnce) {
    const Folder folder;
    folder.write("meshes/one triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("parts.xml",
                 "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" "
                 "value=\"meshes/../meshes/one triangle.obj\"/><transform name=\"to_world\"><translate z=\"2\"/>"
                 "</transform></shape></scene>");
    const LoadedScene s = read(
        folder, scene_with("<shape type=\"obj\"><string name=\"filename\" value=\"meshes/one triangle.obj\"/></shape>"
                           "<include filename=\"parts.xml\"/>"));
    EXPECT_EQ(s.scene->statistics().triangles, 2u);
    EXPECT_EQ(s.scene->statistics().unique_triangles, 1u);
}

TEST(ReaderScene, GroupsAreSeenThroughInstances) {
    const Folder folder;
    const auto hits = [&](const std::string& body) {
        const LoadedScene s = read(folder, scene_with(body));
        return std::make_pair(s.scene->intersect({{0, 0, -10}, {0, 0, 1}}).has_value(),
                              s.scene->intersect({{5, 0, -10}, {0, 0, 1}}).has_value());
    };
    const std::string group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>";
    const std::string instance =
        "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"5\"/>"
        "</transform></shape>";
    EXPECT_EQ(hits(group), std::make_pair(false, false));
    EXPECT_EQ(hits(instance + group), std::make_pair(false, true)) << "a group may stand after its instance";
}

TEST(ReaderScene, TheHashCoversAllFiles) {
    const Folder folder;
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::string text = scene_with("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>");
    folder.write("a.obj", obj);
    const auto first = read(folder, text).scene->content_hash();
    EXPECT_EQ(read(folder, "<!-- the same -->" + text).scene->content_hash(), first);
    folder.write("a.obj", obj + "# ");
    EXPECT_NE(read(folder, text).scene->content_hash(), first);
    folder.write("a.obj", obj);
    ReaderOptions options;
    options.width = 100;
    EXPECT_NE(read(folder, text, options).scene->content_hash(), first);
    EXPECT_EQ(read(folder, text).scene->content_hash(), first);
}

// Without flip_tex_coords, OBJ files have v = 0 at the bottom of an image and other formats at its top.
TEST(ReaderScene, FlipsTextureCoordinatesAsMitsubaDoes) {
    const Folder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    const std::string bsdf = "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\"/></bsdf>";
    const auto v_at_corner = [&](const std::string& flag) {
        const LoadedScene s = read(
            folder,
            scene_with("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/>" + flag + bsdf + "</shape>"));
        return s.scene->intersect({{0.1, 0.2, 1}, {0, 0, -1}})->uv.y();
    };
    // Vertices are floats: 1e-6 is a few of their roundings.
    EXPECT_NEAR(v_at_corner(""), 0.2, 1e-6);
    EXPECT_NEAR(v_at_corner("<boolean name=\"flip_tex_coords\" value=\"false\"/>"), 0.8, 1e-6);
    EXPECT_NEAR(v_at_corner("<boolean name=\"flipTexCoords\" value=\"true\"/>"), 0.2, 1e-6);
}

struct SharedScene {
    const char* folder;
    const char* file;
    std::size_t triangles;  // of its README
    std::size_t emitters;
};

class RealScene : public testing::TestWithParam<SharedScene> {};

TEST_P(RealScene, Loads) {
    const std::string file =
        std::string(KEYHOLE_SOURCE_DIR) + "/../shared/scenes/" + GetParam().folder + "/" + GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "real scenes are not here: " << file;
    const LoadedScene s = read_scene(file);
    EXPECT_THAT(s.warnings, IsEmpty());
    EXPECT_EQ(s.scene->emitters().size(), GetParam().emitters);
    EXPECT_GE(s.scene->statistics().triangles, GetParam().triangles);
    EXPECT_GT(s.scene->max_path_length(), 4);
    // The sensor sees something in the middle of the picture.
    const FilmSettings& film = s.scene->film();
    const SensorRay r =
        s.scene->sensor().ray(s.scene->sensor().sample_point({0.5, 0.5}), {0.5 * film.width, 0.5 * film.height});
    EXPECT_TRUE(s.scene->intersect({r.o, r.d}).has_value());
}

INSTANTIATE_TEST_SUITE_P(All, RealScene,
                         testing::Values(SharedScene{"cornell-box", "scene_v3.xml", 36, 1},
                                         SharedScene{"veach-mis", "scene_v3.xml", 52, 3},
                                         SharedScene{"veach-bidir", "scene_v3.xml", 11544, 2},
                                         SharedScene{"veach-ajar", "scene_v3.xml", 382690, 1},
                                         SharedScene{"staircase2", "scene_v0.6.xml", 30927, 13},
                                         SharedScene{"water-caustic", "scene_v0.6.xml", 103487, 1}),
                         [](const auto& scene) {
                             std::string name = scene.param.folder;
                             for (char& c : name)
                                 if (c == '-') c = '_';
                             return name;
                         });

}  // namespace
}  // namespace keyhole
