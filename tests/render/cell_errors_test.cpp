// Errors by the disagreement of replicates over cells, on numbers that are known.
#include "render/cell_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/normal_quantile.h"
#include "base/rng.h"
#include "chain/running_mean.h"

namespace keyhole {
namespace {

TEST(CellErrors, CoarserCellsAreSums) {
    Cells cells(32 * 32, 1.0);
    cells[3 * 32 + 5] += 10;  // row 3, column 5
    const Cells sums = coarser(cells, 2);
    ASSERT_EQ(sums.size(), 256u);
    for (std::size_t j = 0; j < sums.size(); ++j) EXPECT_EQ(sums[j], j == 1 * 16 + 2 ? 14 : 4);
    EXPECT_EQ(coarser(sums, 1), sums);
}

// An 8 x 8 grid whose only light, in two replicates 4 and 12, lies in one cell: its mean 8 has the squared standard
// error 16, the 2 x 2 cells about it have 2 on average, all cells 1/8.
TEST(CellErrors, AreStandardErrorsRelativeToPartsOfTheImage) {
    std::vector<Cells> run(2, Cells(64));
    run[0][9] = 4;
    run[1][9] = 12;
    const std::vector<Cells> exact(3, [] {
        Cells c(64);
        c[9] = 8;
        return c;
    }());
    const Cells all = mean_of({run, exact});
    EXPECT_DOUBLE_EQ(all[9], 8);
    EXPECT_DOUBLE_EQ(squared_error(run, all), 16 / (4 + 1.0 / 64) / 64);
    EXPECT_EQ(squared_error(exact, all), 0.0);
    EXPECT_TRUE(std::isinf(squared_error({all}, all)));
    EXPECT_TRUE(std::isinf(squared_error(run, Cells(64))));
}

// Of runs whose replicates are independent and normal, one twice as rough as the other: what the jackknife says is how
// much the logarithm of the ratio of their squared errors varies.
TEST(CellErrors, KnowTheErrorOfTheirRatio) {
    Rng random(3, 0);
    constexpr std::size_t cells = 64, replicates = 16;
    const auto draw_run = [&](double roughness) {
        std::vector<Cells> run(replicates, Cells(cells));
        for (Cells& r : run)
            for (double& cell : r) cell = 1 + roughness * normal_quantile(random.uniform());
        return run;
    };
    RunningMean ratios, variances;
    for (int trial = 0; trial < 400; ++trial) {
        const std::vector<Cells> a = draw_run(0.2), b = draw_run(0.1);
        const Cells all = mean_of({a, b});
        ratios.add(std::log(squared_error(a, all) / squared_error(b, all)));
        const double error = error_of_log_ratio(a, b, all);
        variances.add(error * error);
    }
    EXPECT_NEAR(ratios.mean(), std::log(4), 0.02);
    // The variance of 400 is known to 7%; the jackknife is known to be a little too large.
    EXPECT_NEAR(variances.mean() / ratios.variance(), 1.1, 0.25);
    EXPECT_TRUE(std::isinf(error_of_log_ratio(draw_run(1), std::vector<Cells>(16, Cells(cells)), Cells(cells, 1))));
    EXPECT_TRUE(std::isinf(error_of_log_ratio({{1}, {2}}, {{1}, {2}}, {1})));
}

// Two runs of which one has seen a part of the light only, many times: it is not the better one.
TEST(CellErrors, NoOneErrsByFindingMoreLight) {
    std::vector<Cells> stuck, moves;
    for (std::size_t r = 0; r < 8; ++r) {
        stuck.emplace_back(256);
        moves.emplace_back(256);
        stuck.back()[r] = 64;
        for (std::size_t i = 0; i < 16; ++i) moves.back()[r + 16 * i] += 4;
    }
    const Cells all = mean_of({stuck, moves});
    EXPECT_LT(squared_error(moves, all), squared_error(stuck, all));
}

}  // namespace
}  // namespace keyhole
