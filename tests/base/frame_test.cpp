#include "base/frame.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/warp.h"

namespace keyhole {
namespace {

void expect_orthonormal(const Frame& f) {
    constexpr double tolerance = 8 * 0x1p-53;  // a few roundings per component
    EXPECT_NEAR(f.s.norm(), 1, tolerance);
    EXPECT_NEAR(f.t.norm(), 1, tolerance);
    EXPECT_NEAR(f.s.dot(f.t), 0, tolerance);
    EXPECT_NEAR(f.s.dot(f.n), 0, tolerance);
    EXPECT_NEAR(f.t.dot(f.n), 0, tolerance);
    EXPECT_LT((f.s.cross(f.t) - f.n).norm(), 2 * tolerance);  // right-handed
}

TEST(Frame, IsOrthonormalForAnyNormal) {
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
        const double u = rng.uniform();
        expect_orthonormal(Frame::from_normal(square_to_sphere({u, rng.uniform()}).normalized()));
    }
}

TEST(Frame, IsOrthonormalNearThePoles) {
    for (const double pole : {1.0, -1.0}) {
        expect_orthonormal(Frame::from_normal({0, 0, pole}));
        for (double x = 1e-1; x > 1e-300; x *= 1e-3)
            for (const auto& [cx, cy] : {std::pair(1.0, 0.0), {0.0, -1.0}, {-0.6, 0.8}})
                expect_orthonormal(Frame::from_normal(Vec3(x * cx, x * cy, pole * std::sqrt(1 - x * x))));
    }
    for (const double zero : {0.0, -0.0}) expect_orthonormal(Frame::from_normal({0.6, 0.8, zero}));
}

TEST(Frame, FollowsTheTangent) {
    const Vec3 n = Vec3(1, 2, 3).normalized(), tangent(4, -1, 0.5);
    const Frame f = Frame::from_normal_and_tangent(n, tangent);
    expect_orthonormal(f);
    EXPECT_GT(f.s.dot(tangent), 0);
    EXPECT_NEAR(f.t.dot(tangent), 0, 1e-15 * tangent.norm());
}

TEST(Frame, LocalAndWorldAreInverse) {
    const Frame f = Frame::from_normal(Vec3(1, -2, 0.3).normalized());
    const Vec3 v(0.3, 5, -2);
    EXPECT_LT((f.to_world(f.to_local(v)) - v).norm(), 1e-14);
    EXPECT_LT((f.to_local(f.n) - Vec3::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace keyhole
