#include "scene/malformed_scenes.h"

#include <algorithm>
#include <fstream>
#include <map>

#include "scene/scene_text.h"

namespace keyhole::test {
namespace {

using Scenes = std::vector<MalformedScene>;

std::string sensor_with(const std::string& body, const std::string& type = "perspective") {
    return "<scene version=\"3.0.0\">\n@<sensor type=\"" + type + "\">" + body + "</sensor></scene>";
}

// With the mark at the parameter instead of at the sensor.
std::string sensor_parameter(const std::string& body, const std::string& type = "perspective") {
    return "<scene version=\"3.0.0\">\n<sensor type=\"" + type + "\">\n  " + body + "</sensor></scene>";
}

std::string film_with(const std::string& body) {
    return "<scene version=\"3.0.0\"><sensor type=\"perspective\">\n<film type=\"hdrfilm\">" + body +
           "</film></sensor></scene>";
}

std::string bsdf_with(const std::string& type, const std::string& body) {
    return scene_with("<bsdf type=\"" + type + "\" id=\"b\">\n  " + body + "</bsdf>");
}

std::string shape_with(const std::string& type, const std::string& body) {
    return scene_with("@<shape type=\"" + type + "\">\n " + body + "</shape>");
}

std::string emitter_with(const std::string& type, const std::string& body) {
    return scene_with("<emitter type=\"" + type + "\">\n " + body + "</emitter>");
}

Scenes documents() {
    return {
        {"Empty", "", "no <scene> element"},
        {"NotXml", "@cat", "no <scene> element"},
        {"TextOutside", "<scene version=\"3.0.0\"/>\n @cat", "text outside of the <scene> element: 'cat'"},
        {"Unclosed", "<scene version=\"3.0.0\">\n<bsdf type=\"null\">\n</@scene>", "XML syntax error"},
        {"BadAttribute", "<scene version=\"3.0.0\">\n<bsdf type=@null/></scene>", "XML syntax error"},
        {"WrongRoot", "@<mitsuba version=\"3.0.0\"/>", "the root element is <mitsuba>; it must be <scene>"},
        {"TwoRoots", "<scene version=\"3.0.0\"/>\n@<scene version=\"3.0.0\"/>", "a second root element <scene>"},
        {"NoVersion", "@<scene/>", "<scene> needs the attribute 'version'"},
        {"BadVersion", "@<scene version=\"7.1\"/>", "version '7.1' is not known; valid names: 0.x, 2.x, 3.x"},
        {"Text", scene_with("@<bsdf type=\"diffuse\">grey</bsdf>"), "unexpected text 'grey' inside <bsdf>"},
        {"UnknownElement", scene_with("  @<material type=\"diffuse\"/>"), "unknown element <material> in <scene>"},
        {"MisspelledElement", scene_with("@<shap type=\"cube\"/>"),
         "did you mean 'shape'? valid names: default, include"},
        {"MisplacedElement", scene_with("@<translate x=\"1\"/>"), "misplaced element <translate> in <scene>"},
        {"TopLevelFilm", scene_with("@<film type=\"hdrfilm\"/>"), "it belongs into a sensor"},
        {"UnknownAttribute", scene_with("@<bsdf type=\"null\" color=\"red\"/>"),
         "unknown attribute 'color' of <bsdf>; valid names: type, id, name"},
        {"AttributeTwice", scene_with("@<bsdf type=\"null\" type=\"diffuse\"/>"),
         "attribute 'type' of <bsdf> is given twice"},
        {"NoType", scene_with("@<bsdf id=\"x\"/>"), "<bsdf> needs the attribute 'type'"},
        {"UnresolvedVariable", scene_with("<default name=\"size\" value=\"1\"/>\n@<bsdf type=\"null\" id=\"$sise\"/>"),
         "unresolved variable '$sise'; did you mean 'size'? valid names: size"},
        {"DefaultTwice", scene_with("<default name=\"a\" value=\"1\"/>\n @<default name=\"a\" value=\"2\"/>"),
         "the default 'a' is given twice; first at "},
        {"IdTwice", scene_with("<bsdf type=\"null\" id=\"a\"/>\n@<bsdf type=\"null\" id=\"a\"/>"),
         "the id 'a' is given twice; first at "},
        {"UnresolvedReference",
         scene_with("<bsdf type=\"null\" id=\"glass\"/>\n<shape type=\"cube\">@<ref id=\"gless\"/></shape>"),
         "unresolved reference 'gless'; did you mean 'glass'? valid names: glass"},
        {"ReferenceCycle",
         scene_with("@<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>\n"
                    "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"),
         "bsdf 'a' refers to itself: 'a' -> 'b' -> 'a'"},
        {"IncludeMissing", scene_with("@<include filename=\"nowhere.xml\"/>"),
         "file 'nowhere.xml' not found (looked in "},
        {"IncludeCycle", scene_with("<include filename=\"loop.xml\"/>"), "loop.xml:1:24: include cycle: "},
        {"IncludeBroken", scene_with("<include filename=\"broken.xml\"/>"), "broken.xml:2:23: XML syntax error"},
        {"VariablesThatDouble",
         [] {
             std::string text = "<scene version=\"3.0.0\"><default name=\"v0\" value=\"xxxxxxxx\"/>";
             for (int i = 1; i < 40; ++i)
                 text += "<default name=\"v" + std::to_string(i) + "\" value=\"$v" + std::to_string(i - 1) + "$v" +
                         std::to_string(i - 1) + "\"/>";
             return text + "</scene>";
         }(),
         "grows beyond 1048576 characters"},
        {"ChainTooLong",
         [] {
             std::string body;
             for (int i = 0; i < 100; ++i)
                 body += "<bsdf type=\"twosided\" id=\"b" + std::to_string(i) + "\"><ref id=\"b" +
                         std::to_string(i + 1) + "\"/></bsdf>";
             return scene_with(body + "<bsdf type=\"diffuse\" id=\"b100\"/>");
         }(),
         "bsdfs are nested deeper than 64"},
        {"NestedTooDeep",
         [] {
             std::string text = "<scene version=\"3.0.0\">";
             for (int i = 0; i < 100; ++i) text += "<bsdf type=\"twosided\">";
             for (int i = 0; i < 100; ++i) text += "</bsdf>";
             return text + "</scene>";
         }(),
         "elements are nested deeper than 64"},
    };
}

Scenes parameters() {
    return {
        {"UnknownParameter", bsdf_with("diffuse", "@<rgb name=\"reflectanse\" value=\"1\"/>"),
         "unknown parameter 'reflectanse' of bsdf 'diffuse'; did you mean 'reflectance'? valid names: reflectance"},
        {"ParameterTwice",
         bsdf_with("diffuse", "<rgb name=\"reflectance\" value=\"1\"/>\n@<rgb name=\"reflectance\" value=\"1\"/>"),
         "parameter 'reflectance' of bsdf 'diffuse' is given twice; first at "},
        {"ParameterTwiceInBothDialects",
         bsdf_with("dielectric", "<float name=\"int_ior\" value=\"1.5\"/>\n@<float name=\"intIOR\" value=\"1.4\"/>"),
         "parameter 'int_ior' of bsdf 'dielectric' is given twice"},
        {"ReflectanceAboveOne", bsdf_with("diffuse", "@<rgb name=\"reflectance\" value=\"0.5, 1.2, 0\"/>"),
         "parameter 'reflectance' of bsdf 'diffuse' is 0.5, 1.2, 0; above 1 it would not conserve energy"},
        {"NegativeReflectance", bsdf_with("diffuse", "@<rgb name=\"reflectance\" value=\"-0.1\"/>"),
         "is -0.1, -0.1, -0.1; it must not be negative"},
        {"ColorOfTwo", bsdf_with("diffuse", "@<rgb name=\"reflectance\" value=\"1 2\"/>"),
         "has 2 numbers; it needs 1 or 3"},
        {"BadHexColor", bsdf_with("diffuse", "@<rgb name=\"reflectance\" value=\"#12345g\"/>"),
         "'#12345g' is not a colour like #rrggbb"},
        {"StringForColor", bsdf_with("diffuse", "@<string name=\"reflectance\" value=\"red\"/>"),
         "is a <string>; it must be a colour"},
        {"ColorForNumber", bsdf_with("roughplastic", "@<rgb name=\"alpha\" value=\"0.1\"/>"),
         "parameter 'alpha' of bsdf 'roughplastic' is a <rgb>; it must be <float> or <integer>"},
        {"ColorForScalar", bsdf_with("roughconductor", "@<rgb name=\"alpha\" value=\"0.1, 0.2, 0.3\"/>"),
         "is a colour; only grey can stand for a number here"},
        {"TrailingGarbage", bsdf_with("roughplastic", "@<float name=\"alpha\" value=\"0.1abc\"/>"),
         "parameter 'alpha' of bsdf 'roughplastic': '0.1abc' is not a number"},
        {"NotFinite", bsdf_with("roughplastic", "@<float name=\"alpha\" value=\"nan\"/>"),
         "'nan' is not a finite number"},
        {"Overflow", bsdf_with("roughplastic", "@<float name=\"alpha\" value=\"1e400\"/>"), "'1e400' is out of range"},
        {"FractionForInteger", film_with("@<integer name=\"width\" value=\"1.5\"/>"), "'1.5' is not an integer"},
        {"FloatForInteger", film_with("@<float name=\"width\" value=\"100\"/>"), "is a <float>; it must be <integer>"},
        {"NoBoolean", bsdf_with("plastic", "@<boolean name=\"nonlinear\" value=\"yes\"/>"),
         "'yes' is not a boolean; valid names: true, false"},
        {"SpectrumWithoutColon", bsdf_with("diffuse", "@<spectrum name=\"reflectance\" value=\"400:1 500\"/>"),
         "'500' is not wavelength:value"},
        {"SpectrumBackwards", bsdf_with("diffuse", "@<spectrum name=\"reflectance\" value=\"500:1 400:1\"/>"),
         "wavelength 400 does not increase"},
        {"SpectrumAboveOne", bsdf_with("diffuse", "@<spectrum name=\"reflectance\" value=\"500:1 600:1.5\"/>"),
         "has the value 1.5; above 1"},
        {"SpectrumFile",
         bsdf_with("conductor", "<spectrum name=\"eta\" filename=\"bad.spd\"/><float name=\"k\" value=\"1\"/>"),
         "bad.spd:2:1: spectrum: wavelength 300 does not increase"},
        {"SpectrumPlugin", bsdf_with("diffuse", "@<spectrum name=\"reflectance\" type=\"laser\"/>"),
         "unknown spectrum 'laser'; valid names: blackbody, uniform"},
        {"BlackBodyReflectance", bsdf_with("diffuse", "@<blackbody name=\"reflectance\" temperature=\"5000\"/>"),
         "is a <blackbody>, which only emitters can have"},
        {"SingularTransform",
         scene_with("<shape type=\"cube\">@<transform name=\"to_world\"><scale x=\"0\"/></transform></shape>"),
         "transform 'to_world' is singular: it flattens space"},
        {"MatrixSize",
         scene_with("<shape type=\"cube\"><transform name=\"to_world\">@<matrix value=\"1 2 3\"/></transform></shape>"),
         "<matrix> has 3 numbers; it needs 9 or 16"},
        {"RotationWithoutAxis",
         scene_with("<shape type=\"cube\"><transform name=\"to_world\">@<rotate angle=\"3\"/></transform></shape>"),
         "<rotate> has neither x, y, z nor value"},
        {"LookAtItself",
         scene_with("<shape type=\"cube\"><transform name=\"to_world\">@<lookat origin=\"1,2,3\" target=\"1,2,3\" "
                    "up=\"0,1,0\"/></transform></shape>"),
         "<lookat> origin and target are the same point"},
    };
}

Scenes bsdfs() {
    return {
        {"UnknownBsdf", scene_with(" @<bsdf type=\"difuse\"/>"),
         "unknown bsdf 'difuse'; did you mean 'diffuse'? valid names: diffuse, conductor"},
        {"UnknownMaterial", bsdf_with("conductor", "@<string name=\"material\" value=\"Gold\"/>"),
         "parameter 'material' of bsdf 'conductor' is 'Gold'; valid names: none, Ag, Al, Au"},
        {"MaterialAndEta",
         bsdf_with("conductor",
                   "@<string name=\"material\" value=\"Au\"/><float name=\"eta\" value=\"1\"/><float name=\"k\" "
                   "value=\"1\"/>"),
         "excludes 'eta' and 'k'"},
        {"EtaWithoutK", scene_with("@<bsdf type=\"conductor\"><float name=\"eta\" value=\"1\"/></bsdf>"),
         "bsdf 'conductor' needs the parameter 'k'"},
        {"UnknownGlass", bsdf_with("dielectric", "@<string name=\"int_ior\" value=\"wather\"/>"),
         "is 'wather'; did you mean 'water'?"},
        {"NegativeIor", bsdf_with("dielectric", "@<float name=\"int_ior\" value=\"-1.5\"/>"),
         "is -1.5; it must be between 1e-15 and 1e+15"},
        {"UnknownDistribution", bsdf_with("roughconductor", "@<string name=\"distribution\" value=\"phong\"/>"),
         "is 'phong'; valid names: beckmann, ggx"},
        {"InvisibleNormals", bsdf_with("roughconductor", "@<boolean name=\"sample_visible\" value=\"false\"/>"),
         "is false; visible normals are always sampled"},
        {"AlphaZero", bsdf_with("roughdielectric", "@<float name=\"alpha\" value=\"0\"/>"),
         "parameter 'alpha' of bsdf 'roughdielectric' is 0; it must be between 0.0001"},
        {"AlphaThrice",
         bsdf_with("roughconductor", "@<float name=\"alpha\" value=\"0.1\"/><float name=\"alpha_u\" value=\"0.1\"/>"),
         "excludes 'alpha_u' and 'alpha_v'"},
        {"SamplingWeight", bsdf_with("plastic", "@<float name=\"specular_sampling_weight\" value=\"1\"/>"),
         "unknown parameter 'specular_sampling_weight' of bsdf 'plastic'"},
        {"PhongGain",
         scene_with("@<bsdf type=\"phong\"><float name=\"diffuse_reflectance\" value=\"0.6\"/><float "
                    "name=\"specular_reflectance\" value=\"0.6\"/></bsdf>"),
         "add up to 1.2; above 1 it would not conserve energy"},
        {"MaskOfNothing", scene_with("@<bsdf type=\"mask\"/>"), "bsdf 'mask' needs a nested bsdf"},
        {"Opacity", bsdf_with("mask", "@<float name=\"opacity\" value=\"1.5\"/><bsdf type=\"diffuse\"/>"),
         "is 1.5; it must be between 0 and 1"},
        {"TwoSidedNothing", scene_with("@<bsdf type=\"twosided\"/>"), "has 0 nested bsdfs; it needs one or two"},
        {"TwoSidedGlass", bsdf_with("twosided", "@<bsdf type=\"dielectric\"/>"),
         "bsdf 'twosided' cannot hold 'dielectric': light passes through it"},
        {"BumpOfNothing", scene_with("@<bsdf type=\"bumpmap\"><bsdf type=\"diffuse\"/></bsdf>"),
         "bsdf 'bumpmap' needs a nested texture"},
        {"BlendOfOne",
         scene_with("@<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.5\"/><bsdf type=\"diffuse\"/></bsdf>"),
         "has 1 nested bsdfs; it needs two"},
        {"BlendWithoutWeight",
         scene_with("@<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/></bsdf>"),
         "bsdf 'blendbsdf' needs the parameter 'weight'"},
        {"UnknownTexture", bsdf_with("diffuse", "@<texture name=\"reflectance\" type=\"noise\"/>"),
         "unknown texture 'noise'; valid names: bitmap, checkerboard"},
        {"NoFilename", bsdf_with("diffuse", "@<texture name=\"reflectance\" type=\"bitmap\"/>"),
         "texture 'bitmap' needs the parameter 'filename'"},
        {"NotAnImage",
         bsdf_with("diffuse",
                   "@<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
                   "value=\"picture.png\"/></texture>"),
         "picture.png"},
        {"WrapMode",
         bsdf_with("diffuse",
                   "<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" value=\"picture.png\"/>\n"
                   "@<string name=\"wrap_mode\" value=\"zero\"/></texture>"),
         "is 'zero'; valid names: repeat, mirror, clamp"},
        {"TextureAboveOne",
         bsdf_with("diffuse",
                   "@<texture name=\"reflectance\" type=\"checkerboard\"><rgb name=\"color0\" value=\"3\"/></texture>"),
         "has the value 3; above 1 it would not conserve energy"},
        {"TextureWithoutName", bsdf_with("diffuse", "@<texture type=\"checkerboard\"/>"),
         "unexpected <texture> without a name in bsdf 'diffuse'; valid names: reflectance"},
        {"BsdfForColor",
         scene_with(
             "<bsdf type=\"null\" id=\"n\"/><bsdf type=\"diffuse\">@<ref name=\"reflectance\" id=\"n\"/></bsdf>"),
         "parameter 'reflectance' of bsdf 'diffuse' is a <bsdf>; it must be a colour"},
    };
}

Scenes shapes_and_emitters() {
    return {
        {"UnknownShape", scene_with("@<shape type=\"teapot\"/>"),
         "unknown shape 'teapot'; valid names: obj, ply, serialized, rectangle"},
        {"MissingMesh", scene_with("<shape type=\"obj\">\n@<string name=\"filename\" value=\"a b.obj\"/></shape>"),
         "file 'a b.obj' not found"},
        {"MeshIsFolder", scene_with("<shape type=\"obj\">\n@<string name=\"filename\" value=\"directory\"/></shape>"),
         "is a folder, not a file"},
        {"MeshIndex", shape_with("obj", "<string name=\"filename\" value=\"out of range.obj\"/>"),
         "out of range.obj:4"},
        {"MeshNan", shape_with("obj", "<string name=\"filename\" value=\"not a number.obj\"/>"), "not a number.obj"},
        {"MeshEmpty", shape_with("obj", "<string name=\"filename\" value=\"empty.obj\"/>"), "empty.obj"},
        {"PlyIsNot", shape_with("ply", "<string name=\"filename\" value=\"triangle.obj\"/>"), "triangle.obj"},
        {"RadiusZero", scene_with("<shape type=\"sphere\">@<float name=\"radius\" value=\"0\"/></shape>"),
         "is 0; it must be between 1e-15"},
        {"CenterIsVector", scene_with("<shape type=\"sphere\">@<rgb name=\"center\" value=\"1\"/></shape>"),
         "is a <rgb>; it must be <point>"},
        {"ShearedSphere",
         shape_with("sphere", "<transform name=\"to_world\"><matrix value=\"1 1 0 0 1 0 0 0 1\"/></transform>"),
         "shape 'sphere': "},
        {"TwoBsdfs", scene_with("<shape type=\"cube\"><bsdf type=\"diffuse\"/>\n@<bsdf type=\"diffuse\"/></shape>"),
         "shape 'cube' has a second bsdf; first at "},
        {"PointLightInShape", scene_with("<shape type=\"cube\">@<emitter type=\"point\"/></shape>"),
         "emitter 'point' inside a shape; valid names: area"},
        {"NegativeRadiance",
         scene_with("<shape type=\"cube\"><emitter type=\"area\">\n@<rgb name=\"radiance\" "
                    "value=\"1,-1,1\"/></emitter></shape>"),
         "is 1, -1, 1; it must not be negative"},
        {"FaceNormalsOfSphere",
         scene_with("<shape type=\"sphere\">\n @<boolean name=\"face_normals\" value=\"true\"/></shape>"),
         "unknown parameter 'face_normals' of shape 'sphere'"},
        {"GroupWithoutId", scene_with("@<shape type=\"shapegroup\"/>"), "<shape> needs the attribute 'id'"},
        {"GroupShines",
         scene_with(
             "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\">@<emitter type=\"area\"/></shape></shape>"),
         "an emitter in a shapegroup: instances cannot emit light"},
        {"GroupOfGroups",
         scene_with("<shape type=\"shapegroup\" id=\"g\">@<shape type=\"shapegroup\" id=\"h\"/></shape>"),
         "a shapegroup holds shapes of its own, not groups or instances"},
        {"InstanceOfCube",
         scene_with("<shape type=\"cube\" id=\"c\"/><shape type=\"instance\">@<ref id=\"c\"/></shape>"),
         "an instance refers to a shapegroup, not to a cube"},
        {"InstanceOfNothing", scene_with("@<shape type=\"instance\"/>"), "shape 'instance' needs a nested shape"},
        {"UnknownEmitter", scene_with("@<emitter type=\"sky\"/>"),
         "unknown emitter 'sky'; valid names: area, point, spot"},
        {"FreeAreaLight", scene_with("@<emitter type=\"area\"/>"), "must stand inside the shape that emits"},
        {"TwoEnvironments", scene_with("<emitter type=\"constant\"/>\n@<emitter type=\"constant\"/>"),
         "a second environment emitter; first at "},
        {"NegativeIntensity", emitter_with("point", "@<rgb name=\"intensity\" value=\"-1\"/>"),
         "it must not be negative"},
        {"PositionTwice", emitter_with("point", "@<point name=\"position\" x=\"1\"/><transform name=\"to_world\"/>"),
         "excludes 'to_world'"},
        {"Beam", emitter_with("spot", "@<float name=\"beam_width\" value=\"30\"/>"), "is larger than cutoff_angle"},
        {"NoDirection", emitter_with("directional", "@<vector name=\"direction\" x=\"0\"/>"), "is zero"},
        {"EnvmapMissing", emitter_with("envmap", "@<string name=\"filename\" value=\"sky.exr\"/>"),
         "file 'sky.exr' not found"},
        {"EnvmapIsNoImage",
         scene_with("@<emitter type=\"envmap\"><string name=\"filename\" value=\"picture.png\"/></emitter>"),
         "picture.png"},
        {"TexturedPointLight", emitter_with("point", "@<texture name=\"intensity\" type=\"checkerboard\"/>"),
         "is a <texture>; it must be a colour"},
    };
}

Scenes sensors() {
    return {
        {"NoSensor", "@<scene version=\"3.0.0\"/>", "the scene has no <sensor>"},
        {"TwoSensors", scene_with("@<sensor type=\"perspective\"/>"), "a second sensor; first at "},
        {"UnknownSensor", sensor_with("", "fisheye"),
         "unknown sensor 'fisheye'; valid names: perspective, thinlens, orthographic"},
        {"FovZero", sensor_parameter("@<float name=\"fov\" value=\"0\"/>"),
         "is 0; it must be between 0 and 180 (both excluded)"},
        {"FovFlat", sensor_parameter("@<float name=\"fov\" value=\"180\"/>"),
         "is 180; it must be between 0 and 180 (both excluded)"},
        {"FovAxis", sensor_parameter("@<string name=\"fov_axis\" value=\"z\"/>"),
         "is 'z'; did you mean 'x'? valid names: x, y, diagonal, smaller, larger"},
        {"FovAndFocalLength",
         sensor_parameter("@<string name=\"focal_length\" value=\"50mm\"/><float name=\"fov\" value=\"1\"/>"),
         "excludes 'fov'"},
        {"FocalLength", sensor_parameter("@<string name=\"focal_length\" value=\"50cm\"/>"), "'50cm' is not a number"},
        {"NearBehindFar", sensor_with("<float name=\"near_clip\" value=\"5\"/><float name=\"far_clip\" value=\"1\"/>"),
         "near_clip of sensor 'perspective' is 5; it must be less than far_clip, 1"},
        {"ScaledCamera", sensor_parameter("@<transform name=\"to_world\"><scale value=\"2\"/></transform>"),
         "may only rotate, mirror and translate"},
        {"NoAperture", sensor_with("", "thinlens"), "sensor 'thinlens' needs the parameter 'aperture_radius'"},
        {"ApertureOfPinhole", sensor_parameter("@<float name=\"aperture_radius\" value=\"1\"/>"),
         "unknown parameter 'aperture_radius' of sensor 'perspective'"},
        {"WidthZero", film_with("@<integer name=\"width\" value=\"0\"/>"), "is 0; it must be between 1 and 65536"},
        {"WidthHuge", film_with("@<integer name=\"width\" value=\"1000000\"/>"),
         "is 1000000; it must be between 1 and 65536"},
        {"UnknownFilm", sensor_parameter("@<film type=\"tiff\"/>"),
         "unknown film 'tiff'; valid names: hdrfilm, ldrfilm"},
        {"Crop",
         "<scene version=\"3.0.0\"><sensor type=\"perspective\">\n@<film type=\"hdrfilm\"><integer "
         "name=\"crop_offset_x\" value=\"700\"/>"
         "<integer name=\"crop_width\" value=\"100\"/></film></sensor></scene>",
         "the crop window of 100x576 pixels at 700, 0 is not inside the film of 768x576"},
        {"UnknownFilter", film_with("@<rfilter type=\"lanczos\"/>"),
         "unknown rfilter 'lanczos'; valid names: box, tent, gaussian"},
        {"UnknownSampler", sensor_parameter("@<sampler type=\"random\"/>"),
         "unknown sampler 'random'; valid names: independent, stratified"},
        {"UnknownIntegrator", scene_with("@<integrator type=\"rasterizer\"/>"),
         "unknown integrator 'rasterizer'; valid names: path, bdpt"},
        {"DepthZero", scene_with("<integrator type=\"path\">@<integer name=\"max_depth\" value=\"0\"/></integrator>"),
         "is 0; it must be positive, or -1 for any"},
        {"IntegratorParameter",
         scene_with("<integrator type=\"path\">@<integer name=\"maxDeph\" value=\"3\"/></integrator>"),
         "unknown parameter 'maxDeph' of integrator 'path'; did you mean 'max_depth'?"},
    };
}

// Removes the mark from the text and notes the line and column it stood at.
void take_mark(MalformedScene& scene) {
    const auto at = scene.text.find('@');
    if (at == std::string::npos) return;
    scene.text.erase(at, 1);
    const std::string before = scene.text.substr(0, at);
    scene.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    scene.column = static_cast<int>(at - (before.rfind('\n') + 1)) + 1;  // npos + 1 is 0
}

}  // namespace

std::string MalformedScene::place(const std::string& file) const {
    return line == 0 ? "" : file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

std::vector<MalformedScene> malformed_scenes() {
    Scenes all;
    for (const Scenes& some : {documents(), parameters(), bsdfs(), shapes_and_emitters(), sensors()})
        all.insert(all.end(), some.begin(), some.end());
    for (MalformedScene& scene : all) {
        take_mark(scene);
        scene.unknown_parameter = scene.message.rfind("unknown parameter ", 0) == 0 ||
                                  scene.message.rfind("unexpected <texture> without a name", 0) == 0;
    }
    return all;
}

std::vector<std::string> write_malformed_parts(const std::filesystem::path& folder) {
    const std::map<std::string, std::string> files = {
        {"triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"out of range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
        {"not a number.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n"},
        {"empty.obj", "# nothing\n"},
        {"picture.png", "this is not a picture"},
        {"loop.xml", "<scene version=\"3.0.0\"><include filename=\"loop.xml\"/></scene>"},
        {"broken.xml", "<scene version=\"3.0.0\">\n  <bsdf type=\"null\"></scene>"},
        {"bad.spd", "400 1\n300 1\n"},
    };
    std::vector<std::string> names = {"directory"};
    std::filesystem::create_directories(folder / names.front());
    for (const auto& [name, text] : files) {
        std::ofstream(folder / name, std::ios::binary) << text;
        names.push_back(name);
    }
    return names;
}

}  // namespace keyhole::test
