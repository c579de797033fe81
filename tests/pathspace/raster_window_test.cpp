// Positions on the film and their numbers.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "pathspace/subpath.h"

namespace keyhole {
namespace {

// Every number gives a position of the window, and every position of it, border pixels' corners included, a number in
// [0, 1) that gives it back to the last digits. Outside there is nothing.
TEST(RasterWindow, NumbersAndPositionsAreInverse) {
    Rng rng(3, 1);
    for (const auto& [x, y, width, height] :
         {std::array{0, 0, 1, 1}, {0, 0, 640, 360}, {639, 0, 1, 360}, {13, 211, 100, 7}, {7000, 4000, 1000, 500}}) {
        FilmSettings film;
        film.width = 8000;
        film.height = 4500;
        film.crop_x = x;
        film.crop_y = y;
        film.crop_width = width;
        film.crop_height = height;
        const RasterWindow window(film);
        const auto comes_back = [&](const Vec2& position) {
            ASSERT_TRUE(window.contains(position)) << position.transpose();
            const Vec2 u = window.to_unit(position);
            ASSERT_TRUE(u.minCoeff() >= 0 && u.maxCoeff() < 1);
            ASSERT_LE((window.at(u) - position).norm(), 1e-12 * 8000) << position.transpose();
        };
        for (const double u1 : {0.0, 0.5, one_minus_epsilon})
            for (const double u2 : {0.0, 0.5, one_minus_epsilon}) {
                const Vec2 u = window.to_unit(window.at({u1, u2}));
                EXPECT_LE((u - Vec2(u1, u2)).norm(), 1e-11);
                EXPECT_LT(u.maxCoeff(), 1);
            }
        for (int i = 0; i < width; ++i)
            for (int j = 0; j < height; ++j) {
                if (i > 0 && j > 0 && i < width - 1 && j < height - 1) continue;
                comes_back(Vec2(x + i, y + j));
                comes_back(Vec2(std::nextafter(x + i + 1.0, 0.0), std::nextafter(y + j + 1.0, 0.0)));
                comes_back(Vec2(x + i + rng.uniform(), y + j + 0.5));
            }
        EXPECT_FALSE(window.contains(Vec2(x + width, y)));
        EXPECT_FALSE(window.contains(Vec2(x, y + height)));
        EXPECT_FALSE(window.contains(Vec2(std::nextafter(double(x), -1.0), y)));
    }
}

}  // namespace
}  // namespace keyhole
