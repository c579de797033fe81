// The linear and the bilinear warp: sampler, density and inverse belong together.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/warp.h"

namespace keyhole {
namespace {

const double slopes[][2] = {{1, 1}, {0, 1}, {1, 0}, {0, 0}, {1, 1e6}, {1e6, 1}, {1e-30, 3e-30}, {2, 5}};

// The derivative of the inverse is the density, and the inverse undoes the sampler.
TEST(LinearWarp, InverseUndoesSampleAndItsDerivativeIsThePdf) {
    const double h = 1e-6;
    for (const auto& [a, b] : slopes)
        for (int i = 1; i < 100; ++i) {
            const double u = 0.01 * i, x = unit_to_linear(u, a, b);
            EXPECT_NEAR(linear_to_unit(x, a, b), u, 1e-12) << a << " " << b;
            // Central differences of a quadratic err by rounding only.
            const double slope = (linear_to_unit(u + h, a, b) - linear_to_unit(u - h, a, b)) / (2 * h);
            EXPECT_NEAR(unit_to_linear_pdf(u, a, b), slope, 1e-8) << a << " " << b;
        }
}

TEST(LinearWarp, EndsStayInTheUnitInterval) {
    for (const auto& [a, b] : slopes)
        for (const double u : {0.0, 0x1p-1074, one_minus_epsilon}) {
            const double x = unit_to_linear(u, a, b);
            EXPECT_TRUE(x >= 0 && x < 1) << a << " " << b << " " << u;
            const double back = linear_to_unit(u, a, b);
            EXPECT_TRUE(back >= 0 && back < 1) << a << " " << b << " " << u;
        }
}

TEST(BilinearWarp, InverseUndoesSampleAndItsJacobianIsThePdf) {
    Rng rng(1);
    const double h = 1e-6;
    for (const Bilinear& f : {Bilinear{1, 1, 1, 1}, Bilinear{0, 0, 0, 0}, Bilinear{0, 0, 0, 1}, Bilinear{1, 0, 0, 1},
                              Bilinear{1, 20, 3, 0.1}, Bilinear{0, 1, 0, 1}})
        for (int i = 0; i < 100; ++i) {
            const double u0 = 0.01 + 0.98 * rng.uniform();
            const Vec2 u(u0, 0.01 + 0.98 * rng.uniform()), p = square_to_bilinear(u, f);
            EXPECT_LE((bilinear_to_square(p, f) - u).norm(), 1e-12);
            const Vec2 dx = bilinear_to_square(u + Vec2(h, 0), f) - bilinear_to_square(u - Vec2(h, 0), f);
            const Vec2 dy = bilinear_to_square(u + Vec2(0, h), f) - bilinear_to_square(u - Vec2(0, h), f);
            const double jacobian = (dx.x() * dy.y() - dx.y() * dy.x()) / (4 * h * h);
            // A step of 1e-6 at least 1e-2 from where the conditional density vanishes.
            EXPECT_NEAR(square_to_bilinear_pdf(u, f), jacobian, 1e-6);
        }
}

}  // namespace
}  // namespace keyhole
