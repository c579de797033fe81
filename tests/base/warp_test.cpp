#include "base/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <string>

#include "base/rng.h"
#include "statistics.h"

namespace keyhole {
namespace {

// A warp onto a part of the plane or sphere, seen through an area-preserving chart of its own: `chart` takes a point of
// the domain to [0,1)^2, so that a cell of the chart has the probability integral of pdf * jacobian.
struct WarpCase {
    std::string name;
    std::function<Vec3(const Vec2&)> warp;
    std::function<Vec2(const Vec3&)> inverse;
    std::function<double(const Vec3&)> pdf;
    std::function<Vec3(const Vec2&)> point;  // the chart: [0,1)^2 to the domain, not through the warp
    std::function<Vec2(const Vec3&)> chart;
    double jacobian;  // area of the domain per area of the chart
};

std::ostream& operator<<(std::ostream& out, const WarpCase& c) { return out << c.name; }

// Directions with z in [z_min, 1]: (z, phi).
WarpCase spherical(std::string name, double z_min, std::function<Vec3(const Vec2&)> warp,
                   std::function<Vec2(const Vec3&)> inverse, std::function<double(const Vec3&)> pdf) {
    const double height = 1 - z_min;
    const auto point = [=](const Vec2& c) {
        const double z = z_min + height * c.x(), r = safe_sqrt(1 - z * z), phi = 2 * pi * c.y();
        return Vec3(r * std::cos(phi), r * std::sin(phi), z);
    };
    const auto chart = [=](const Vec3& w) {
        const double phi = std::atan2(w.y(), w.x()) / (2 * pi);
        return Vec2((w.z() - z_min) / height, phi < 0 ? phi + 1 : phi);
    };
    return {std::move(name), std::move(warp), std::move(inverse), std::move(pdf), point, chart, 2 * pi * height};
}

WarpCase disk() {
    const auto point = [](const Vec2& c) {
        const double r = std::sqrt(c.x()), phi = 2 * pi * c.y();
        return Vec3(r * std::cos(phi), r * std::sin(phi), 0);
    };
    const auto chart = [](const Vec3& p) {
        const double phi = std::atan2(p.y(), p.x()) / (2 * pi);
        return Vec2(p.squaredNorm(), phi < 0 ? phi + 1 : phi);
    };
    const auto warp = [](const Vec2& u) {
        const Vec2 p = square_to_disk(u);
        return Vec3(p.x(), p.y(), 0);
    };
    return {"disk",
            warp,
            [](const Vec3& p) {
                return disk_to_square({p.x(), p.y()});
            },
            [](const Vec3&) { return square_to_disk_pdf(); },
            point,
            chart,
            pi};
}

// Barycentric coordinates on x + y < 1, area 1/2; the chart folds the square at x + y = 1.
WarpCase triangle() {
    const auto warp = [](const Vec2& u) {
        const Vec2 b = square_to_triangle(u);
        return Vec3(b.x(), b.y(), 0);
    };
    const auto point = [](const Vec2& c) { return Vec3(1 - std::sqrt(c.x()), c.y() * std::sqrt(c.x()), 0); };
    const auto chart = [](const Vec3& p) { return Vec2(sqr(1 - p.x()), p.y() / (1 - p.x())); };
    return {"triangle",
            warp,
            [](const Vec3& p) {
                return triangle_to_square({p.x(), p.y()});
            },
            [](const Vec3&) { return 2.0; },
            point,
            chart,
            0.5};
}

std::vector<WarpCase> cases() {
    std::vector<WarpCase> list = {
        disk(), triangle(),
        spherical("sphere", -1, square_to_sphere, sphere_to_square, [](const Vec3&) { return square_to_sphere_pdf(); }),
        spherical("cosine_hemisphere", 0, square_to_cosine_hemisphere, cosine_hemisphere_to_square,
                  square_to_cosine_hemisphere_pdf)};
    for (const auto& [name, z] : {std::pair("cone_wide", -0.5), {"cone", 0.7}, {"cone_narrow", 1 - 1e-9}})
        list.push_back(spherical(
            name, z, [z = z](const Vec2& u) { return square_to_cone(u, z); },
            [z = z](const Vec3& w) { return cone_to_square(w, z); },
            [z = z](const Vec3&) { return square_to_cone_pdf(z); }));
    for (const auto& [name, n] : {std::pair("power_0", 0.0), {"power_3", 3.0}, {"power_40", 40.0}})
        list.push_back(spherical(
            name, 0, [n = n](const Vec2& u) { return square_to_cosine_power(u, n); },
            [n = n](const Vec3& w) { return cosine_power_to_square(w, n); },
            [n = n](const Vec3& w) { return square_to_cosine_power_pdf(w, n); }));
    return list;
}

// One p-value per case; all together raise a false alarm with probability 1e-3.
const double level = sidak_level(1e-3, 10);

class WarpTest : public testing::TestWithParam<WarpCase> {};

TEST_P(WarpTest, FollowsItsDensity) {
    constexpr int n = 100000, side = 16, fine = 32;
    const WarpCase& c = GetParam();
    std::vector<double> observed(side * side), expected(side * side);
    const auto cell = [](const Vec2& p) {
        const auto index = [](double t) { return static_cast<std::size_t>(std::clamp(t * side, 0.0, side - 1.0)); };
        return index(p.x()) * side + index(p.y());
    };
    Rng rng(1);
    for (int i = 0; i < n; ++i) {
        const double u = rng.uniform();
        ++observed[cell(c.chart(c.warp({u, rng.uniform()})))];
    }
    for (int i = 0; i < side * fine; ++i)
        for (int j = 0; j < side; ++j) {  // densities do not depend on the second chart coordinate within a cell
            const Vec2 p((i + 0.5) / (side * fine), (j + 0.5) / side);
            expected[cell(p)] += n * c.pdf(c.point(p)) * c.jacobian / (side * side * fine);
        }
    EXPECT_GT(chi_square_p_value(expected, observed), level);
}

TEST_P(WarpTest, InverseReturnsTheNumbers) {
    const WarpCase& c = GetParam();
    Rng rng(2);
    for (int i = 0; i < 20000; ++i) {
        const double u1 = rng.uniform();
        const Vec2 u(u1, rng.uniform()), v = c.inverse(c.warp(u));
        // Coordinates are angles or squared radii of order one, found again to a few ulps: on the torus, as azimuths
        // wrap. The power lobe's first number is the (n+1)-th power of a cosine, with n+1 times the relative error.
        for (int k = 0; k < 2; ++k) {
            const double d = std::abs(u[k] - v[k]);
            ASSERT_LT(std::min(d, 1 - d), 1e-14) << "u = " << u.transpose() << ", v = " << v.transpose();
        }
    }
}

TEST_P(WarpTest, BordersAndCentreMapIntoTheDomain) {
    const WarpCase& c = GetParam();
    const std::array numbers = {0.0, 0x1p-1074, 0x1p-53, 0.25, 0.5 - 0x1p-54, 0.5, 0.75, one_minus_epsilon};
    for (const double u1 : numbers)
        for (const double u2 : numbers) {
            const Vec3 p = c.warp({u1, u2});
            ASSERT_TRUE(p.allFinite()) << u1 << ' ' << u2;
            ASSERT_TRUE(std::isfinite(c.pdf(p)));
            ASSERT_TRUE(p.z() == 0 || std::abs(p.norm() - 1) < 4e-16) << "plane or unit sphere";
            const Vec2 v = c.inverse(p);
            EXPECT_TRUE(v.x() >= 0 && v.x() < 1 && v.y() >= 0 && v.y() < 1) << v.transpose();
            EXPECT_LT((c.warp(v) - p).norm(), 1e-14) << u1 << ' ' << u2;
        }
}

std::string case_name(const testing::TestParamInfo<WarpCase>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(All, WarpTest, testing::ValuesIn(cases()), case_name);

TEST(ConcentricMap, QuarterCircleFunctionsAgreeWithLibm) {
    // Truncation is below half an ulp of 1, evaluation adds about one.
    for (int i = -100000; i <= 100000; ++i) {
        const double t = i / 100000.0, phi = t * (pi / 4);
        ASSERT_NEAR(cos_quarter_pi(t), std::cos(phi), 2.3e-16) << t;
        ASSERT_NEAR(sin_quarter_pi(t), std::sin(phi), 2.3e-16) << t;
    }
}

TEST(ConcentricMap, IsThePublishedMap) {
    Rng rng(3);
    for (int i = 0; i < 10000; ++i) {
        const double u1 = rng.uniform(), u2 = rng.uniform(), a = 2 * u1 - 1, b = 2 * u2 - 1;
        const bool wide = std::abs(a) > std::abs(b);
        const double r = wide ? a : b, phi = wide ? pi / 4 * b / a : pi / 2 - pi / 4 * a / b;
        ASSERT_LT((square_to_disk({u1, u2}) - Vec2(r * std::cos(phi), r * std::sin(phi))).norm(), 5e-16);
    }
    EXPECT_EQ(square_to_disk({0.5, 0.5}), Vec2(0, 0));
}

TEST(CosineHemisphere, KeepsItsDigitsAtTheHorizon) {
    // u.x = d puts the point at radius 1 - 2d: cos theta = 2 sqrt(d (1 - d)).
    for (const double d : {1e-3, 1e-8, 1e-15}) {
        const double a = 2 * d - 1, radius = -a;  // d as far as 2d - 1 can hold it
        const double exact = std::sqrt((1 - radius) * (1 + radius));
        EXPECT_NEAR(square_to_cosine_hemisphere({d, 0.5}).z(), exact, 1e-15 * exact);
        EXPECT_GT(square_to_cosine_hemisphere({d, 0.5}).z(), 0);
    }
}

TEST(SphereWarp, InverseKeepsItsDigitsAtThePoles) {
    for (const double u : {1e-3, 1e-10, 1e-20, 1e-100})
        EXPECT_NEAR(sphere_to_square(square_to_sphere({u, 0.3})).x(), u, 1e-14 * u);
}

TEST(CosinePower, NarrowLobesKeepTheirShape) {
    // n = 1e8: the median lies at h = ln 2 / (n + 1) below the pole.
    const Vec3 w = square_to_cosine_power({0.5, 0.25}, 1e8);
    const double h = std::log(2.0) / (1e8 + 1);
    EXPECT_NEAR(w.y(), std::sqrt(2 * h), 1e-8 * std::sqrt(2 * h));
    EXPECT_NEAR(cosine_power_to_square(w, 1e8).x(), 0.5, 1e-14);
}

}  // namespace
}  // namespace keyhole
