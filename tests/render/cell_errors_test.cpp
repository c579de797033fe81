// Errors by the disagreement of replicates over cells, on numbers that are known.
#include "render/cell_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

TEST(CellErrors, BlocksAreSumsOfTheirCells) {
    constexpr std::size_t side = BlockGrid::usual_side, fine = 2;
    Cells cells(side * fine * side * fine, 1.0);
    cells[3 * side * fine + 5] += 10;  // row 3, column 5
    const Cells blocks = blocks_of(cells, fine);
    ASSERT_EQ(blocks.size(), side * side);
    for (std::size_t j = 0; j < blocks.size(); ++j) EXPECT_EQ(blocks[j], j == 1 * side + 2 ? 14 : 4);
    EXPECT_EQ(blocks_of(blocks, 1), blocks);
}

// Two replicates, 1 and 3: their mean 2 has the squared standard error 1. Beside it a cell without light.
TEST(CellErrors, AreStandardErrorsRelativeToTheImage) {
    const std::vector<Cells> run = {{1, 0}, {3, 0}};
    const Cells all = mean_of({run, {{2, 0}, {2, 0}, {2, 0}}});
    EXPECT_DOUBLE_EQ(all[0], 2);
    EXPECT_EQ(all[1], 0);
    EXPECT_DOUBLE_EQ(squared_error(run, all), 0.5 * 1 / (4 + 0.05 * 0.05));
    EXPECT_EQ(squared_error({{2, 0}, {2, 0}}, all), 0.0);
    EXPECT_TRUE(std::isinf(squared_error({{2, 0}}, all)));
    EXPECT_TRUE(std::isinf(squared_error(run, {0, 0})));
}

}  // namespace
}  // namespace keyhole
