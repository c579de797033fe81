// The distributions against their definitions by quadrature, and the sampler of visible normals against its density.
#include "scene/microfacet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/rng.h"
#include "statistics.h"

namespace keyhole {
namespace {

struct Case {
    MicrofacetType type;
    double alpha_x, alpha_y;

    Microfacet microfacet() const { return {type, alpha_x, alpha_y}; }
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << (c.type == MicrofacetType::ggx ? "GGX " : "Beckmann ") << c.alpha_x << " x " << c.alpha_y;
}

class MicrofacetTest : public testing::TestWithParam<Case> {};

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
        for (const double alpha : {1e-4, 1e-3, 0.02, 0.1, 0.25, 0.5, 1.0}) list.push_back({type, alpha, alpha});
        list.push_back({type, 0.1, 0.5});
        list.push_back({type, 1.0, 1e-3});
    }
    return list;
}

INSTANTIATE_TEST_SUITE_P(All, MicrofacetTest, testing::ValuesIn(cases()));

Vec3 direction(double cos_theta, double phi) {
    const double s = safe_sqrt((1 - cos_theta) * (1 + cos_theta));
    return {s * std::cos(phi), s * std::sin(phi), cos_theta};
}

std::vector<Vec3> view_directions() {
    std::vector<Vec3> list = {{0, 0, 1}};
    for (const double degrees : {30.0, 60.0, 80.0, 89.0}) list.push_back(direction(std::cos(degrees * pi / 180), 0.7));
    list.push_back(direction(1e-4, 2.5));
    list.push_back(direction(0.5, 0));
    return list;
}

// A facet normal by its slopes in units of the roughness, and the density of solid angle in that plane.
Vec3 normal_at(const Case& c, double sx, double sy) { return Vec3(c.alpha_x * sx, c.alpha_y * sy, 1).normalized(); }
double solid_angle(const Case& c, const Vec3& m) { return c.alpha_x * c.alpha_y * m.z() * m.z() * m.z(); }

// Integral of g(m) over the upper hemisphere of normals, on polar slopes r = v / (1 - v), by the midpoint rule.
template <class G>
double integrate(const Case& c, const G& g, int rings = 400, int spokes = 240) {
    double sum = 0;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < spokes; ++j) {
            const double v = (i + 0.5) / rings, r = v / (1 - v), phi = 2 * pi * (j + 0.5) / spokes;
            const Vec3 m = normal_at(c, r * std::cos(phi), r * std::sin(phi));
            sum += g(m) * solid_angle(c, m) * r / sqr(1 - v);
        }
    return sum * 2 * pi / (rings * spokes);
}

TEST_P(MicrofacetTest, FacetsCoverTheMacroSurface) {
    const Microfacet microfacet = GetParam().microfacet();
    const double area = integrate(GetParam(), [&](const Vec3& m) { return microfacet.density(m) * m.z(); });
    EXPECT_NEAR(area, 1, 1e-5);  // the midpoint rule's error is 1e-6
}

// A(w) is the area of the facets that face w, projected along w: with it visible normals are normalised, which is the
// weak white furnace test, integral of D G1 / (4 |cos w|) over reflected directions = 1 [Heitz 2014, 5.2].
TEST_P(MicrofacetTest, ProjectedAreaIsThatOfFacetsThatFaceTheDirection) {
    const Microfacet microfacet = GetParam().microfacet();
    for (const Vec3& w : view_directions()) {
        const double area =
            integrate(GetParam(), [&](const Vec3& m) { return microfacet.density(m) * std::max(0.0, w.dot(m)); });
        // The kink at w.m = 0 costs the midpoint rule 1e-5 of the slopes' scale.
        EXPECT_NEAR(area / microfacet.projected_area(w), 1, 2e-4) << w.transpose();
        EXPECT_NEAR(microfacet.g1(w), w.z() / microfacet.projected_area(w), 1e-15);
        EXPECT_NEAR(microfacet.projected_area(Vec3(-w)) / microfacet.projected_area(w), 1, 1e-15);
    }
}

// Published closed forms, written with tan(theta) [Walter et al. 2007, eq. 25, 33, 34; Heitz 2014, eq. 66, 72].
TEST_P(MicrofacetTest, AgreesWithThePublishedFormulas) {
    const Case& c = GetParam();
    const Microfacet microfacet = c.microfacet();
    for (double cos_theta = 0.02; cos_theta < 1; cos_theta += 0.07)
        for (double phi = 0.1; phi < 6; phi += 0.9) {
            const Vec3 w = direction(cos_theta, phi);
            const double tan2 = (1 - cos_theta * cos_theta) / (cos_theta * cos_theta), cos4 = std::pow(cos_theta, 4);
            const double slope2 = tan2 * (sqr(std::cos(phi) / c.alpha_x) + sqr(std::sin(phi) / c.alpha_y));
            const double along2 = tan2 * (sqr(std::cos(phi) * c.alpha_x) + sqr(std::sin(phi) * c.alpha_y));
            const double a = 1 / std::sqrt(along2), scale = 1 / (pi * c.alpha_x * c.alpha_y * cos4);
            const bool ggx = c.type == MicrofacetType::ggx;
            const double d = ggx ? scale / sqr(1 + slope2) : scale * std::exp(-slope2);
            const double g1 =
                ggx ? 2 / (1 + std::sqrt(1 + along2)) : 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi)));
            EXPECT_NEAR(microfacet.g1(w) / g1, 1, 1e-12);
            // exp(-x) turns a relative error of x into x times as much.
            EXPECT_NEAR(microfacet.density(w), d, 1e-14 * d * (10 + std::min(slope2, 1e4)) + 1e-250);
        }
}

// Change of variables: the density times the Jacobian of the map is 1 (central differences in the plane of scaled
// slopes). Together with the inverse this shows that the sampler has exactly the stated density.
TEST_P(MicrofacetTest, JacobianOfTheSamplerIsTheInverseOfItsDensity) {
    const Case& c = GetParam();
    const Microfacet microfacet = c.microfacet();
    const auto slopes = [&](const Vec3& w, const Vec2& u) -> Vec2 {
        const Vec3 m = microfacet.sample_visible(w, u);
        return {m.x() / (m.z() * c.alpha_x), m.y() / (m.z() * c.alpha_y)};
    };
    Rng rng(1);
    for (const Vec3& w : view_directions())
        for (int i = 0; i < 400; ++i) {
            const Vec2 u(0.02 + 0.96 * rng.uniform(), 0.02 + 0.96 * rng.uniform());
            constexpr double h = 1e-5;
            // The concentric map has kinks on the diagonals.
            if (std::abs(std::abs(u.x() - 0.5) - std::abs(u.y() - 0.5)) < 3 * h) continue;
            const Vec2 dx = (slopes(w, u + Vec2(h, 0)) - slopes(w, u - Vec2(h, 0))) / (2 * h);
            const Vec2 dy = (slopes(w, u + Vec2(0, h)) - slopes(w, u - Vec2(0, h))) / (2 * h);
            const Vec3 m = microfacet.sample_visible(w, u);
            const double jacobian = std::abs(dx.x() * dy.y() - dx.y() * dy.x()) * solid_angle(c, m);
            // Differences: h^2 times the third derivative, which is at most 1e3 this far from the edges.
            EXPECT_NEAR(jacobian * microfacet.visible_density(w, m), 1, 2e-5)
                << w.transpose() << " u " << u.transpose();
        }
}

TEST_P(MicrofacetTest, InverseReturnsTheNumbers) {
    const Microfacet microfacet = GetParam().microfacet();
    Rng rng(2);
    for (const Vec3& w : view_directions())
        for (int i = 0; i < 2000; ++i) {
            const Vec2 u(rng.uniform(), rng.uniform());
            const Vec3 m = microfacet.sample_visible(w, u);
            ASSERT_GT(w.dot(m), 0);
            ASSERT_NEAR(m.norm(), 1, 1e-15);
            // Rounding of m and of the slopes: some ulp of a unit slope.
            EXPECT_NEAR((microfacet.visible_to_square(w, m) - u).norm(), 0, 1e-12)
                << w.transpose() << " u " << u.transpose();
        }
}

TEST_P(MicrofacetTest, EdgesOfTheSquareAreUpperUnitNormals) {
    const Microfacet microfacet = GetParam().microfacet();
    const std::array numbers = {0.0, 0x1p-53, 1e-9, 0.25, 0.5, 0.75, 1 - 1e-9, one_minus_epsilon};
    for (const Vec3& w : view_directions())
        for (const double u1 : numbers)
            for (const double u2 : numbers) {
                const Vec3 m = microfacet.sample_visible(w, {u1, u2});
                ASSERT_TRUE(m.allFinite()) << w.transpose() << " u " << u1 << " " << u2;
                EXPECT_GT(m.z(), 0);
                EXPECT_NEAR(m.norm(), 1, 1e-15);
                EXPECT_TRUE(std::isfinite(microfacet.visible_density(w, m)));
                const Vec2 u = microfacet.visible_to_square(w, m);
                EXPECT_TRUE(u.x() >= 0 && u.x() < 1 && u.y() >= 0 && u.y() < 1) << u.transpose();
            }
}

// Chi-square over rings and spokes of scaled slopes, expectations by quadrature of the density. 18 cases x 7 directions
// at level 1e-3 together.
TEST_P(MicrofacetTest, SamplesFollowTheDensityOfVisibleNormals) {
    constexpr int rings = 12, spokes = 16, fine = 12, samples = 40000;
    const Case& c = GetParam();
    const Microfacet microfacet = c.microfacet();
    std::uint64_t stream = 0;
    for (const Vec3& w : view_directions()) {
        std::vector<double> expected(rings * spokes, 0), observed(rings * spokes, 0);
        const auto cell = [&](double v, double turn) {
            const int ring = std::min(static_cast<int>(v * rings), rings - 1);
            const int spoke = std::min(static_cast<int>(turn * spokes), spokes - 1);
            return static_cast<std::size_t>(ring * spokes + spoke);
        };
        for (int i = 0; i < rings * fine; ++i)
            for (int j = 0; j < spokes * fine; ++j) {
                const double v = (i + 0.5) / (rings * fine), r = v / (1 - v), turn = (j + 0.5) / (spokes * fine);
                const Vec3 m = normal_at(c, r * std::cos(2 * pi * turn), r * std::sin(2 * pi * turn));
                const double density = microfacet.visible_density(w, m) * solid_angle(c, m) * r / sqr(1 - v);
                expected[cell(v, turn)] += samples * density * 2 * pi / (rings * fine * spokes * fine);
            }
        Rng rng(3, ++stream);
        for (int i = 0; i < samples; ++i) {
            const double u1 = rng.uniform(), u2 = rng.uniform();
            const Vec3 m = microfacet.sample_visible(w, {u1, u2});
            const double sx = m.x() / (m.z() * c.alpha_x), sy = m.y() / (m.z() * c.alpha_y), r = std::hypot(sx, sy);
            const double turn = std::atan2(sy, sx) / (2 * pi);
            ++observed[cell(r / (1 + r), turn < 0 ? turn + 1 : turn)];
        }
        EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(1e-3, 18 * 7)) << w.transpose();
    }
}

// Unlike the fixed tolerance above: the tails of the Gaussian, where one ulp of a slope is many of a small probability.
TEST(Microfacet, BeckmannInverseIsRelativelyAccurateInTheTail) {
    const Microfacet microfacet(MicrofacetType::beckmann, 0.3, 0.3);
    for (const Vec3& w : view_directions())
        for (double u = 1e-14; u < 0.1; u *= 1.7) {
            const Vec2 back = microfacet.visible_to_square(w, microfacet.sample_visible(w, {u, u}));
            EXPECT_NEAR(back.x() / u, 1, 1e-11) << w.transpose() << " u " << u;
            EXPECT_NEAR(back.y() / u, 1, 1e-11) << w.transpose() << " u " << u;
        }
}

TEST(Microfacet, SmoothLimitShowsOneNormalUnmasked) {
    for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
        const Microfacet microfacet(type, 0, 0);
        Rng rng(4);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 m = microfacet.sample_visible(direction(0.6, 1), {rng.uniform(), rng.uniform()});
            EXPECT_LT(std::hypot(m.x(), m.y()), 100 * Microfacet::min_alpha);  // a GGX slope above 100: p = 1e-4
        }
        EXPECT_NEAR(microfacet.g1(direction(0.01, 1)), 1, 1e-4);
        EXPECT_NEAR(microfacet.density({0, 0, 1}) * pi * sqr(Microfacet::min_alpha), 1, 1e-12);
    }
}

// Both directions exact: the pair of densities of a reflection comes from D / (4 A), the value from both.
TEST(Microfacet, FacetReflectionIsTheHalfVectorForm) {
    const Microfacet microfacet(MicrofacetType::beckmann, 0.2, 0.6);
    const Vec3 eye = direction(0.3, 0.2), light = direction(0.8, 3), m = (eye + light).normalized();
    const FacetReflection r = facet_reflection(microfacet, eye, light);
    EXPECT_NEAR(r.cos_m, eye.dot(m), 1e-15);
    EXPECT_NEAR(r.pdf_light, microfacet.visible_density(eye, m) / (4 * eye.dot(m)), 1e-12);
    EXPECT_NEAR(r.pdf_eye, microfacet.visible_density(light, m) / (4 * light.dot(m)), 1e-12);
    const double g = microfacet.g1(eye) * microfacet.g1(light);
    EXPECT_NEAR(r.value, microfacet.density(m) * g / (4 * eye.z() * light.z()), 1e-12);
}

// u -> m -> u' on the torus. Rounding moves m by about epsilon, and u by epsilon over the smallest singular value of
// dm/du, which finite differences give, as well as by the epsilon of its own last digit times what the view direction's
// own rounding is worth there.
TEST(VisibleNormals, ComeBackToTheirNumbers) {
    Rng rng(8, 1);
    double worst = 0;
    for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann})
        for (const double alpha : {1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0})
            for (const double degrees : {0.0, 1.0, 45.0, 80.0, 89.0, 89.9, 89.99}) {
                const Microfacet microfacet(type, alpha, alpha);
                const Vec3 w = direction(std::cos(degrees * pi / 180), 0.3);
                for (int i = 0; i < 1000; ++i) {
                    const double u1 = 0.001 + 0.998 * rng.uniform();
                    const Vec2 u{u1, 0.001 + 0.998 * rng.uniform()};
                    const Vec3 m = microfacet.sample_visible(w, u);
                    const Vec2 back = microfacet.visible_to_square(w, m);
                    constexpr double h = 1e-6;
                    const Vec3 d1 = (microfacet.sample_visible(w, u + Vec2(h, 0)) - m) / h,
                               d2 = (microfacet.sample_visible(w, u + Vec2(0, h)) - m) / h;
                    // Area over the largest singular value, which the longer of the columns is within sqrt(2) of.
                    const double least = d1.cross(d2).norm() / std::max(d1.norm(), d2.norm());
                    const auto torus = [](double a) { return std::min(std::abs(a), 1 - std::abs(a)); };
                    const double error = std::hypot(torus(back.x() - u.x()), torus(back.y() - u.y()));
                    const double bound = 0x1p-53 * (1 + 1 / least);
                    worst = std::max(worst, error / bound);
                    ASSERT_LE(error, 100 * bound)
                        << Case{type, alpha, alpha} << " at " << degrees << " degrees, u = " << u.transpose()
                        << ", least singular value " << least;
                }
            }
    std::cout << "worst error " << worst << " times epsilon and condition\n";
}

}  // namespace
}  // namespace keyhole
