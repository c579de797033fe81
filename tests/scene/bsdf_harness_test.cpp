// The suite of bsdf_harness.h. Its instances are in the files that list the cases.
#include "bsdf_harness.h"

namespace keyhole {

TEST_P(BsdfTest, SamplingFollowsPdf) { EXPECT_TRUE(sampling_follows_pdf(GetParam())); }
TEST_P(BsdfTest, SampleAgreesWithEval) { EXPECT_TRUE(sample_agrees_with_eval(GetParam())); }
TEST_P(BsdfTest, DeltaSamplesAreReversible) { EXPECT_TRUE(delta_samples_are_reversible(GetParam())); }
TEST_P(BsdfTest, IsReciprocalUnlessStated) {
    if (GetParam().reciprocal)
        EXPECT_TRUE(is_reciprocal(GetParam()));
    else
        EXPECT_FALSE(is_reciprocal(GetParam()));
}
TEST_P(BsdfTest, ConservesEnergy) { EXPECT_TRUE(conserves_energy(GetParam())); }
TEST_P(BsdfTest, SurvivesExtremes) { EXPECT_TRUE(survives_extremes(GetParam())); }
TEST_P(BsdfTest, InverseGivesTheSample) { EXPECT_TRUE(inverse_gives_the_sample(GetParam())); }
TEST_P(BsdfTest, InverseNumbersAreUniform) { EXPECT_TRUE(inverse_numbers_are_uniform(GetParam())); }
TEST_P(BsdfTest, DensitiesOfTheBranches) { EXPECT_TRUE(densities_of_the_branches(GetParam())); }
TEST_P(BsdfTest, InvertsAnyDirection) { EXPECT_TRUE(inverts_any_direction(GetParam())); }
TEST_P(BsdfTest, InverseSurvivesBorders) { EXPECT_TRUE(inverse_survives_borders(GetParam())); }
TEST_P(BsdfTest, LobeNumberOnlyChooses) { EXPECT_TRUE(lobe_number_only_chooses(GetParam())); }

}  // namespace keyhole
