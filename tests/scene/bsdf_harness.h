// The tests that every BSDF has to pass. A test file lists its cases and instantiates the suite:
//
//   INSTANTIATE_TEST_SUITE_P(Smooth, BsdfTest, testing::ValuesIn(cases()), bsdf_case_name);
//
// The tests themselves are in bsdf_harness_test.cpp; the checks are also usable one by one.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "scene/bsdfs.h"

namespace keyhole {

// A point of a flat surface with the identity as frame and uneven tangents.
SurfacePoint flat_point();

struct BsdfCase {
    std::string name;  // letters, digits and underscores
    BsdfPtr bsdf;
    double eta = 1;               // index of refraction of the -z side over the one of the +z side
    bool lossless_front = false;  // all light that comes from +z (-z) is scattered: white furnace
    bool lossless_back = false;
    bool reciprocal = true;  // f(a, b) / eta_a^2 = f(b, a) / eta_b^2; bump maps are not
    SurfacePoint x = flat_point();
};

inline std::ostream& operator<<(std::ostream& out, const BsdfCase& c) { return out << c.name; }
inline std::string bsdf_case_name(const testing::TestParamInfo<BsdfCase>& info) { return info.param.name; }

class BsdfTest : public testing::TestWithParam<BsdfCase> {};

// Directions on both sides: normal incidence, moderate, 80 and 89.99 degrees, three azimuths.
std::vector<Vec3> known_directions();

// A texture of constant value `color` and luminance gradient `slope`, whatever the uv.
std::shared_ptr<const Texture> constant_texture(const Spectrum& color, const Vec2& slope = {0, 0});

// `sample` draws smooth directions with the density of `eval`, delta lobes with their probability, and nothing else:
// chi-square over a grid of the sphere, one cell per delta lobe and one for absence; both modes. The p-values of all
// known directions are held against bsdf_test_level.
testing::AssertionResult sampling_follows_pdf(const BsdfCase& c);

// Every test program has at most 4000 of these p-values, so that their false alarms have level 1e-3 overall.
double bsdf_test_level();

// pdf, pdf_reverse and weight of a smooth sample are those of `eval`, to 1e-9 relative; a delta sample is found again
// from its other end with the two probabilities exchanged, the index inverted and the adjoint coefficient.
testing::AssertionResult sample_agrees_with_eval(const BsdfCase& c);
testing::AssertionResult delta_samples_are_reversible(const BsdfCase& c);

// f(w_eye = a, w_light = b) / eta_a^2 is symmetric, to 1e-9 relative [Veach 1997, 5.2].
testing::AssertionResult is_reciprocal(const BsdfCase& c);

// The scattered power (Mode::light: the mean weight; Mode::eye: the mean of weight * eta^2, with radiance scaling taken
// out) is at most 1, and 1 where the case is lossless, within 6 standard errors.
testing::AssertionResult conserves_energy(const BsdfCase& c);

// Numbers at both ends of [0, 1) and directions at and near the horizon and the normal give finite samples that keep
// to the traits; exactly grazing directions evaluate to zero.
testing::AssertionResult survives_extremes(const BsdfCase& c);

// Numbers from `invert` give the sample back: the same lobe where it is a delta lobe, the direction to 1e-7 of the lobe's
// width, the density to 1e-5 relative.
testing::AssertionResult inverse_gives_the_sample(const BsdfCase& c);

// Uniform numbers that give a sample, and numbers from `invert` of such samples, have one distribution: chi-square of two
// samples over the cube of the three numbers, at bsdf_test_level. Seen red with lobes drawn by their probabilities alone.
testing::AssertionResult inverse_numbers_are_uniform(const BsdfCase& c);

// pdf is the sum over the smooth branches of c_l / |dw/du|, by finite differences (1e-3), and `invert` chooses each in
// its share of that sum, the posterior (2/128). Seen red with lobes drawn by their probabilities alone.
testing::AssertionResult densities_of_the_branches(const BsdfCase& c);

// Directions that no sample gave, on both sides, among them mirrored and straight ones: where the density is zero there
// is no smooth inverse; elsewhere there is one that gives the direction back, to 1e-6 of the lobe's width; only at
// densities below 1e-8, far in a tail, there may be none. Never a delta lobe in its place.
testing::AssertionResult inverts_any_direction(const BsdfCase& c);

// Samples at both ends of [0, 1) have inverses in [0, 1), or none; never NaN, never 1.
testing::AssertionResult inverse_survives_borders(const BsdfCase& c);

// The lobe number chooses the lobe and nothing else; without `chooses_lobe` it has no effect at all.
testing::AssertionResult lobe_number_only_chooses(const BsdfCase& c);

}  // namespace keyhole
