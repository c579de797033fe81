#include "scene/fresnel.h"

#include <gtest/gtest.h>

#include <complex>

#include "base/rng.h"
#include "base/warp.h"

namespace keyhole {
namespace {

using Wide = long double;

// The textbook form (amplitudes as differences), in 64-bit mantissas.
Wide textbook_dielectric(Wide c, Wide eta) {
    const Wide ct = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const Wide s = (c - eta * ct) / (c + eta * ct), p = (eta * c - ct) / (eta * c + ct);
    return (s * s + p * p) / 2;
}

Wide textbook_conductor(Wide c, Wide eta, Wide k) {
    const std::complex<Wide> index(eta, k), q = std::sqrt(index * index - (1 - c * c));
    return (std::norm((c - q) / (c + q)) + std::norm((index * index * c - q) / (index * index * c + q))) / 2;
}

// Closed form of the diffuse reflectance from outside, eta > 1 [Walsh 1926; Duntley 1942].
Wide walsh(Wide n) {
    const Wide n2 = n * n, n4 = n2 * n2;
    return 0.5L + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3.0L) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

TEST(FresnelDielectric, AgreesWithTheTextbookFormula) {
    for (const double eta : {0.3, 0.66, 0.99, 1.01, 1.33, 1.5, 2.4, 10.0})
        for (double c = 1; c > 1e-5; c *= 0.9) {
            if (1 - c * c > 0.999 * eta * eta) continue;  // the reference itself loses digits at the critical angle
            const double expected = static_cast<double>(textbook_dielectric(c, eta));
            // Brewster's angle makes r_p vanish, so the error is relative to the reflectance as a whole.
            EXPECT_NEAR(fresnel_dielectric(c, eta).reflectance, expected, 1e-13 * expected) << c << ' ' << eta;
        }
}

TEST(FresnelDielectric, KnownAngles) {
    EXPECT_DOUBLE_EQ(fresnel_dielectric(1, 1.5).reflectance, 0.04);
    EXPECT_DOUBLE_EQ(fresnel_dielectric(1, 1 / 1.5).reflectance, 0.04);
    const double brewster = 1 / std::sqrt(1 + 1.5 * 1.5), r_s = (1 - 1.5 * 1.5) / (1 + 1.5 * 1.5);
    EXPECT_NEAR(fresnel_dielectric(brewster, 1.5).reflectance, r_s * r_s / 2, 1e-16);
    EXPECT_EQ(fresnel_dielectric(0, 1.5).reflectance, 1);
    EXPECT_EQ(fresnel_dielectric(0, 1.5).transmittance, 0);
    EXPECT_EQ(fresnel_dielectric(0, 1).reflectance, 1);
    EXPECT_EQ(fresnel_dielectric(0.3, 1).reflectance, 0);
    EXPECT_EQ(fresnel_dielectric(0.3, 1).transmittance, 1);
}

TEST(FresnelDielectric, TotalInternalReflection) {
    const double eta = 1 / 1.5, critical = std::sqrt((1 - eta) * (1 + eta));
    const DielectricFresnel inside = fresnel_dielectric(critical * (1 - 1e-12), eta);
    EXPECT_EQ(inside.reflectance, 1);
    EXPECT_EQ(inside.transmittance, 0);
    EXPECT_EQ(inside.cos_t, 0);
    // Just outside the transmittance grows like the square root of the distance.
    const DielectricFresnel outside = fresnel_dielectric(critical * (1 + 1e-12), eta);
    EXPECT_GT(outside.transmittance, 1e-6);
    EXPECT_LT(outside.transmittance, 1e-4);
    EXPECT_NEAR(outside.reflectance + outside.transmittance, 1, 1e-15);
}

TEST(FresnelDielectric, SharesSumToOneAndAreEqualFromBothSides) {
    Rng rng(1);
    for (int i = 0; i < 20000; ++i) {
        const double eta = std::exp(2 * rng.uniform() - 1), c = std::pow(rng.uniform(), 4);
        const DielectricFresnel f = fresnel_dielectric(c, eta);
        ASSERT_NEAR(f.reflectance + f.transmittance, 1, 1e-14) << c << ' ' << eta;
        if (f.transmittance < 1e-4) continue;
        const DielectricFresnel back = fresnel_dielectric(f.cos_t, 1 / eta);
        // cos^2 is found again with an absolute error of a few ulps of 1 + eta^2.
        const double error = 4 * 0x1p-53 * (1 + eta * eta) / sqr(c);
        ASSERT_NEAR(back.cos_t, c, error * c) << c << ' ' << eta;
        ASSERT_NEAR(back.transmittance, f.transmittance, (error + 1e-14) * f.transmittance) << c << ' ' << eta;
    }
}

TEST(FresnelDielectric, KeepsItsDigitsNearEqualIndices) {
    for (const double d : {1e-3, 1e-6, 1e-9, 1e-12}) {
        const double eta = 1 + d, exact = eta - 1;  // what is left of d after rounding
        EXPECT_NEAR(fresnel_dielectric(1, eta).reflectance, sqr(exact / (2 + exact)), 1e-14 * d * d);
        const double c = 0.5, q = std::sqrt(c * c + exact * (2 + exact));
        const double r_s = -exact * (2 + exact) / sqr(c + q);
        EXPECT_GT(fresnel_dielectric(c, eta).reflectance, 0.5 * r_s * r_s * (1 - 1e-14));
    }
}

TEST(FresnelDielectric, TransmittanceKeepsItsDigitsAtGrazingAngles) {
    // T -> 2 cos (1 + eta^2) / sqrt(eta^2 - 1), first order in cos.
    for (const double c : {1e-6, 1e-9, 1e-12, 1e-15}) {
        const double limit = 2 * c * (1 + 2.25) / std::sqrt(1.25);
        EXPECT_NEAR(fresnel_dielectric(c, 1.5).transmittance, limit, 10 * c * limit + 1e-15 * limit);
    }
}

TEST(FresnelConductor, AgreesWithComplexArithmetic) {
    for (const double eta : {0.05, 0.2, 1.0, 1.5, 4.0})
        for (const double k : {0.0, 1e-6, 0.5, 3.0, 8.0})
            for (double c = 1; c > 1e-5; c *= 0.8) {
                if (k < 1e-3 && std::abs(1 - c * c - eta * eta) < 1e-3) continue;  // critical angle of the reference
                const double expected = static_cast<double>(textbook_conductor(c, eta, k));
                // With equal indices nothing reflects: the error there is absolute.
                EXPECT_NEAR(fresnel_conductor(c, eta, k), expected, 1e-13 * expected + 1e-18)
                    << eta << ' ' << k << ' ' << c;
            }
}

TEST(FresnelConductor, LimitsAndDielectricCase) {
    for (const double c : {0.0, 1e-12, 0.3, 1.0}) {
        EXPECT_EQ(fresnel_conductor(c, 0, 1), 1);  // the perfect mirror
        EXPECT_EQ(fresnel_conductor(c, 0, 0), 1);
    }
    EXPECT_EQ(fresnel_conductor(0, 1.5, 2), 1);
    EXPECT_EQ(fresnel_conductor(0, 1, 0), 1);
    for (const double c : {1e-3, 0.2, 0.9, 1.0})
        EXPECT_NEAR(fresnel_conductor(c, 1.5, 0), fresnel_dielectric(c, 1.5).reflectance, 1e-15);
    const Spectrum rgb = fresnel_conductor(0.5, Spectrum(0.14, 0.37, 1.44), Spectrum(3.98, 2.38, 1.60));
    EXPECT_EQ(rgb[1], fresnel_conductor(0.5, 0.37, 2.38));
}

TEST(FresnelDiffuse, AgreesWithTheClosedForm) {
    for (const double eta : {1.05, 1.33, 1.5, 1.9, 2.4, 4.0, 10.0}) {
        const double outside = static_cast<double>(walsh(eta));
        EXPECT_NEAR(fresnel_diffuse_reflectance(eta), outside, 1e-10 * outside) << eta;
        EXPECT_NEAR(fresnel_diffuse_reflectance(1 / eta), 1 - (1 - outside) / sqr(eta), 1e-10) << eta;
    }
}

TEST(FresnelDiffuse, IntegratesTheReflectanceFromInside) {
    // Midpoint rule; the kink at the critical angle leaves an error of order n^-1.5.
    constexpr int n = 200000;
    for (const double eta : {1 / 1.5, 0.9, 1.00001, 1.2}) {
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const double c = (i + 0.5) / n;
            sum += 2 * c * fresnel_dielectric(c, eta).reflectance / n;
        }
        EXPECT_NEAR(fresnel_diffuse_reflectance(eta), sum, 1e-7) << eta;
    }
    EXPECT_EQ(fresnel_diffuse_reflectance(1), 0);
}

TEST(Refraction, KeepsToSnellsLaw) {
    Rng rng(2);
    for (int i = 0; i < 2000; ++i) {
        const double u0 = rng.uniform(), u1 = rng.uniform(), u2 = rng.uniform(), u3 = rng.uniform();
        const Vec3 w = square_to_sphere({u0, u1}), m = square_to_sphere({u2, u3});
        const double eta = 0.5 + rng.uniform(), cos_i = w.dot(m);
        EXPECT_NEAR((reflect(w, m) + w - 2 * cos_i * m).norm(), 0, 1e-15);
        const DielectricFresnel f = fresnel_dielectric(std::abs(cos_i), eta);
        if (f.transmittance == 0) continue;
        const Vec3 t = refract(w, m, f.cos_t, eta);
        ASSERT_NEAR(t.norm(), 1, 1e-14);
        ASSERT_LT(t.dot(m) * cos_i, 0);
        ASSERT_NEAR((t.cross(m) * eta + w.cross(m)).norm(), 0, 1e-14);
        ASSERT_LT((refract(w, -m, f.cos_t, eta) - t).norm(), 1e-15);
    }
}

TEST(Refraction, LocalFormsAreTheGeneralOnesAboutZ) {
    for (const Vec3& w : {Vec3(0.6, 0, 0.8), Vec3(-0.36, 0.48, -0.8), Vec3(0, 0, 1)}) {
        EXPECT_EQ(reflect(w), reflect(w, Vec3::UnitZ()));
        const double cos_t = fresnel_dielectric(abs_cos_theta(w), 1.5).cos_t;
        EXPECT_LT((refract(w, cos_t, 1.5) - refract(w, Vec3::UnitZ(), cos_t, 1.5)).norm(), 1e-15);
    }
}

}  // namespace
}  // namespace keyhole
