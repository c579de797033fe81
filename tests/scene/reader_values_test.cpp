// Values of scene files: numbers, colours, spectra, names and transforms.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/reader/cie.h"
#include "scene/reader/colors.h"
#include "scene/reader/materials.h"
#include "scene/reader/names.h"
#include "scene/reader/transforms.h"
#include "scene/reader/values.h"
#include "scene_text.h"

namespace keyhole {
namespace {

using test::Folder;

const SourceLocation here{"here.xml", 3, 4};

Element element(const std::string& tag, std::vector<Attribute> attributes, std::vector<Element> children = {}) {
    return {tag, std::move(attributes), std::move(children), here};
}

Spectrum color(const Element& e, Quantity quantity = Quantity::reflectance) {
    Document document;
    document.filename = here.file;
    return parse_color(e, quantity, "color", document);
}

void expect_near(const Spectrum& a, const Spectrum& b, double tolerance) {
    EXPECT_TRUE(((a - b).abs() <= tolerance).all()) << a.transpose() << " is not " << b.transpose();
}

TEST(ReaderNumbers, AreReadStrictly) {
    EXPECT_EQ(parse_number(" 1.5e-3\n", here, "x"), 1.5e-3);
    EXPECT_EQ(parse_number("+2", here, "x"), 2);
    EXPECT_EQ(parse_number("-4.37114e-008", here, "x"), -4.37114e-8);
    EXPECT_EQ(parse_integer("-7", here, "x"), -7);
    EXPECT_TRUE(parse_boolean(" true ", here, "x"));
    EXPECT_FALSE(parse_boolean("false", here, "x"));
    EXPECT_EQ(parse_with_unit("50mm", "mm", here, "x"), 50);
    EXPECT_EQ(parse_with_unit("35.5 mm", "mm", here, "x"), 35.5);
    EXPECT_EQ(parse_numbers("1, 2,3 4\t5", here, "x"), (std::vector<double>{1, 2, 3, 4, 5}));
    for (const char* bad : {"", " ", "1.2x", "nan", "inf", "-inf", "1e999", "0x10", "+-1", "--1", "1 2", "1,5"})
        EXPECT_THROW(parse_number(bad, here, "x"), InputError) << bad;
    for (const char* bad : {"", "1.0", "99999999999", "1e3", "one"})
        EXPECT_THROW(parse_integer(bad, here, "x"), InputError) << bad;
    for (const char* bad : {"True", "1", "yes", ""}) EXPECT_THROW(parse_boolean(bad, here, "x"), InputError) << bad;
    for (const char* bad : {"", "1,", ",1", "1,,2", "1 x"})
        EXPECT_THROW(parse_numbers(bad, here, "x"), InputError) << bad;
}

TEST(ReaderNames, OfBothDialectsAreOne) {
    EXPECT_EQ(canonical_parameter("toWorld"), "to_world");
    EXPECT_EQ(canonical_parameter("to_world"), "to_world");
    EXPECT_EQ(canonical_parameter("intIOR"), "int_ior");
    EXPECT_EQ(canonical_parameter("alphaU"), "alpha_u");
    EXPECT_EQ(canonical_parameter("specularReflectance"), "specular_reflectance");
    EXPECT_EQ(canonical_parameter("filterType"), "filter_type");
    EXPECT_EQ(canonical_parameter("principalPointOffsetX"), "principal_point_offset_x");
    EXPECT_EQ(canonical_parameter("extEta"), "ext_eta");
    EXPECT_EQ(canonical_parameter("vflip"), "flip_tex_coords");
    EXPECT_EQ(canonical_tag("lookAt"), "lookat");
}

TEST(ReaderColors, OfEveryKind) {
    expect_near(color(element("rgb", {{"value", "0.1, 0.2 0.3"}})), {0.1, 0.2, 0.3}, 0);
    expect_near(color(element("rgb", {{"value", "0.25"}})), {0.25, 0.25, 0.25}, 0);
    expect_near(color(element("float", {{"value", "0.25"}})), {0.25, 0.25, 0.25}, 0);
    expect_near(color(element("spectrum", {{"value", "0.7"}})), {0.7, 0.7, 0.7}, 0);
    // sRGB 188/255 is 0.5029 linear [IEC 61966-2-1], and 0xff is 1, 0x00 is 0.
    expect_near(color(element("rgb", {{"value", "#bcff00"}})), {0.5029, 1, 0}, 5e-5);
    expect_near(color(element("srgb", {{"value", "0.5, 1, 0"}})), {0.21404, 1, 0}, 5e-6);
}

TEST(ReaderColors, AConstantListIsTheConstant) {
    const auto list = [](const char* value) { return element("spectrum", {{"value", value}}); };
    expect_near(color(list("400:1, 700:1")), {1, 1, 1}, 1e-12);
    expect_near(color(list("400:0.3 500:0.3 600:0.3"), Quantity::index), {0.3, 0.3, 0.3}, 1e-12);
    // Red reflects long wavelengths: it has a red channel well above the others.
    const Spectrum red = color(list("400:0 580:0 600:1 700:1"));
    EXPECT_GT(red[0], 0.8);
    EXPECT_LT(red[1], 0.2);
    EXPECT_LT(red[2], 0.05);
}

TEST(ReaderColors, ASpectrumFileIsAList) {
    const Folder folder;
    const std::string file = folder.write("metal.spd", "# eta\n 400 1.5 # first\n\n 700\t1.5\n");
    const Spectrum c = color(element("spectrum", {{"filename", file}}), Quantity::index);
    expect_near(c, {1.5, 1.5, 1.5}, 1e-12);
    const std::string bad = folder.write("bad.spd", "400 1\n500 x\n");
    try {
        color(element("spectrum", {{"filename", bad}}));
        FAIL() << "a bad number was read";
    } catch (const InputError& e) {
        EXPECT_EQ(e.where().file, bad);
        EXPECT_EQ(e.where().line, 2);
    }
}

TEST(ReaderColors, CieFunctionsAreThoseOfTheStandardObserver) {
    // CIE 1931 values at three wavelengths and the integral of y, 106.857; the fit is good to about 1% of the peak
    // [Wyman et al. 2013, table 1].
    EXPECT_NEAR(cie_xyz(450).z(), 1.77211, 0.02);
    EXPECT_NEAR(cie_xyz(555).y(), 1.0, 0.02);
    EXPECT_NEAR(cie_xyz(600).x(), 1.0622, 0.02);
    Vec3 equal(0, 0, 0), daylight(0, 0, 0);
    for (int nm = 360; nm <= 830; ++nm) {
        equal += cie_xyz(nm);
        daylight += cie_xyz(nm) * cie_d65(nm);
    }
    EXPECT_NEAR(equal.y(), 106.857, 0.5);
    // Chromaticities: (1/3, 1/3) for equal energy and (0.3127, 0.3290) for D65.
    EXPECT_NEAR(equal.x() / equal.sum(), 1.0 / 3, 2e-3);
    EXPECT_NEAR(equal.y() / equal.sum(), 1.0 / 3, 2e-3);
    EXPECT_NEAR(daylight.x() / daylight.sum(), 0.3127, 2e-3);
    EXPECT_NEAR(daylight.y() / daylight.sum(), 0.3290, 2e-3);
}

TEST(ReaderColors, ABlackBodyShinesByPlancksLaw) {
    // Wien: the maximum of 5800 K lies at 499.6 nm.
    EXPECT_GT(planck(499.6, 5800), planck(490, 5800));
    EXPECT_GT(planck(499.6, 5800), planck(510, 5800));
    // The integral over all wavelengths is sigma T^4 / pi [Stefan-Boltzmann], here in nm up to 1 mm.
    double total = 0;
    for (double nm = 50; nm < 1e6; nm *= 1.001) total += planck(nm * 1.0005, 3000) * nm * 0.001;
    EXPECT_NEAR(total / (5.670374e-8 * std::pow(3000, 4) / pi), 1, 1e-3);

    const auto body = [](const char* t, const char* scale) {
        return element("blackbody", {{"temperature", t}, {"scale", scale}});
    };
    const Spectrum warm = color(body("3000K", "1"), Quantity::emission);
    EXPECT_GT(warm[0], warm[1]);
    EXPECT_GT(warm[1], warm[2]);
    // 6500 K is close to the white of sRGB.
    const Spectrum white = color(body("6500", "1"), Quantity::emission);
    EXPECT_NEAR(white[0] / white[1], 1, 0.06);
    EXPECT_NEAR(white[2] / white[1], 1, 0.06);
    // Luminance: the mean of Planck's law over y lies near its value at 560 nm.
    EXPECT_NEAR(luminance(white) / planck(560, 6500), 1, 0.05);
    expect_near(color(body("6500", "0.5"), Quantity::emission), 0.5 * white, 1e-9 * white.maxCoeff());
    EXPECT_THROW(color(body("6500", "1"), Quantity::reflectance), InputError);
}

TEST(ReaderMaterials, HaveKnownValues) {
    EXPECT_EQ(dielectric_by_name("water"), 1.3330);
    EXPECT_FALSE(dielectric_by_name("Water"));
    const auto gold = conductor_by_name("Au");
    ASSERT_TRUE(gold);
    EXPECT_LT(gold->eta[0], gold->eta[2]);
    EXPECT_EQ(conductor_by_name("none")->k[1], 1);
    EXPECT_FALSE(conductor_by_name("unobtainium"));
    EXPECT_EQ(conductor_names().size(), 28u);
    for (const auto& name : conductor_names()) EXPECT_GE(conductor_by_name(name)->eta.minCoeff(), 0) << name;
}

Affine transform(std::vector<Element> operations) {
    return parse_transform(element("transform", {{"name", "to_world"}}, std::move(operations)));
}

void expect_maps(const Affine& t, const Vec3& from, const Vec3& to) {
    EXPECT_LT((t * from - to).norm(), 1e-12) << (t * from).transpose() << " is not " << to.transpose();
}

TEST(ReaderTransforms, EachOperation) {
    expect_maps(transform({}), {1, 2, 3}, {1, 2, 3});
    expect_maps(transform({element("translate", {{"y", "2"}})}), {1, 2, 3}, {1, 4, 3});
    expect_maps(transform({element("translate", {{"value", "1, 2, 3"}})}), {0, 0, 0}, {1, 2, 3});
    expect_maps(transform({element("scale", {{"value", "2"}})}), {1, 2, 3}, {2, 4, 6});
    expect_maps(transform({element("scale", {{"x", "2"}})}), {1, 2, 3}, {2, 2, 3});
    expect_maps(transform({element("scale", {{"value", "2 3 4"}})}), {1, 1, 1}, {2, 3, 4});
    expect_maps(transform({element("rotate", {{"z", "1"}, {"angle", "90"}})}), {1, 0, 0}, {0, 1, 0});
    expect_maps(transform({element("rotate", {{"value", "0,0,5"}, {"angle", "-90"}})}), {1, 0, 0}, {0, -1, 0});
    expect_maps(transform({element("matrix", {{"value", "0 -1 0 5  1 0 0 6  0 0 2 7  0 0 0 1"}})}), {1, 2, 3},
                {3, 7, 13});
    expect_maps(transform({element("matrix", {{"value", "0 -1 0  1 0 0  0 0 2"}})}), {1, 2, 3}, {-2, 1, 6});
}

TEST(ReaderTransforms, LookAtSeesItsTarget) {
    const Affine t = transform({element("lookat", {{"origin", "1, 2, 3"}, {"target", "1, 2, -5"}, {"up", "0, 3, 1"}})});
    expect_maps(t, {0, 0, 0}, {1, 2, 3});
    expect_maps(t, {0, 0, 8}, {1, 2, -5});  // +z towards the target
    expect_maps(t, {0, 1, 0}, {1, 3, 3});   // +y up
    expect_maps(t, {1, 0, 0}, {0, 2, 3});   // +x to the left of who looks along -z
}

TEST(ReaderTransforms, AreAppliedInTheOrderOfTheFile) {
    const Element move = element("translate", {{"x", "1"}}), turn = element("rotate", {{"z", "1"}, {"angle", "90"}});
    expect_maps(transform({move, turn}), {0, 0, 0}, {0, 1, 0});
    expect_maps(transform({turn, move}), {0, 0, 0}, {1, 0, 0});
}

TEST(ReaderTransforms, SingularOnesAreErrors) {
    EXPECT_THROW(transform({element("scale", {{"x", "0"}})}), InputError);
    EXPECT_THROW(transform({element("matrix", {{"value", "1 2 3 2 4 6 0 0 1"}})}), InputError);
    EXPECT_THROW(transform({element("matrix", {{"value", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"}})}), InputError);
    EXPECT_THROW(transform({element("rotate", {{"x", "0"}, {"angle", "1"}})}), InputError);
    EXPECT_THROW(transform({element("lookat", {{"origin", "0,0,0"}, {"target", "0,1,0"}, {"up", "0,1,0"}})}),
                 InputError);
    // Very different lengths of the columns are no flatness.
    EXPECT_NO_THROW(transform({element("scale", {{"value", "1e-6, 1, 1e6"}})}));
}

TEST(ReaderTransforms, OfTextureCoordinates) {
    const auto uv = [](std::vector<Element> operations) {
        return parse_uv_transform(element("transform", {{"name", "to_uv"}}, std::move(operations)));
    };
    const Eigen::Vector3d p(0.5, 0.25, 1);
    EXPECT_TRUE((uv({element("scale", {{"x", "4"}, {"y", "2"}}), element("translate", {{"x", "1"}})}) * p)
                    .isApprox(Eigen::Vector3d(3, 0.5, 1)));
    EXPECT_TRUE((uv({element("matrix", {{"value", "2 0 3 0 4 5 0 0 1"}})}) * p).isApprox(Eigen::Vector3d(4, 6, 1)));
    EXPECT_TRUE((uv({element("rotate", {{"z", "1"}, {"angle", "90"}})}) * p).isApprox(Eigen::Vector3d(-0.25, 0.5, 1)));
    EXPECT_THROW(uv({element("rotate", {{"x", "1"}, {"angle", "30"}})}), InputError);
    EXPECT_THROW(uv({element("scale", {{"x", "0"}})}), InputError);
}

}  // namespace
}  // namespace keyhole
