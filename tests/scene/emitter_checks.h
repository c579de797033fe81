// Checks that every emitter has to pass. Numbers are drawn from fixed seeds; each is called at most 20 times in the
// test program, and the levels of the statistical ones are chosen for a false alarm of 1e-3 over all of these calls.
#pragma once

#include <gtest/gtest.h>

#include "scene/emitter.h"

namespace keyhole {

// pdf_point and pdf_ray give the densities that the samples came with, to 1e-9 relative (0 and 1 at a delta endpoint).
testing::AssertionResult samples_carry_their_densities(const Emitter& emitter);

// Numbers at both ends of [0, 1) give finite samples and densities. (A density may be zero there.)
testing::AssertionResult survives_the_ends_of_the_unit_interval(const Emitter& emitter);

// Chi-square of the directions, or at infinity of the origins on the disk that covers the scene, against pdf_ray.
testing::AssertionResult rays_follow_their_density(const Emitter& emitter, const Vec3& center, double radius);

// Numbers from the inverses give endpoint and ray back, to 1e-9 relative, with its density to 1e-6.
testing::AssertionResult inverse_gives_the_sample(const Emitter& emitter);

// Numbers from the inverses of uniform samples are uniform: chi-square over cells of their cube and square.
testing::AssertionResult inverse_numbers_are_uniform(const Emitter& emitter);

// power() is the mean of emitted / (pdf_point pdf_ray), within the standard errors of a Monte Carlo estimate.
testing::AssertionResult power_is_the_integral(const Emitter& emitter);

}  // namespace keyhole
