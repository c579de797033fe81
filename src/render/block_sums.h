// The light of a coarse grid of blocks of the image.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "pathspace/subpath.h"

namespace keyhole {

// 16 x 16 equal blocks of the window that paths are sampled in, row by row from the top.
class BlockGrid {
  public:
    static constexpr int side = 16, count = side * side;

    explicit BlockGrid(const RasterWindow& window)
        : origin_(window.origin), scale_(Vec2(side, side).cwiseQuotient(window.size)) {}

    // The block of a position in the window.
    int index(const Vec2& raster) const {
        const auto cell = [](double x) { return std::min(static_cast<int>(x), side - 1); };
        return cell((raster.y() - origin_.y()) * scale_.y()) * side + cell((raster.x() - origin_.x()) * scale_.x());
    }

  private:
    Vec2 origin_, scale_;
};

// Sums of weighted luminance by block, without a reconstruction filter. Fixed-point integers: the same in any order.
class BlockSums {
  public:
    static constexpr int fraction_bits = 24;

    void add(int block, double value) { sums_[block] += std::llrint(value * (std::int64_t{1} << fraction_bits)); }
    BlockSums& operator+=(const BlockSums& other) {
        for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
        return *this;
    }
    void clear() { sums_.fill(0); }
    double operator[](int block) const { return std::ldexp(static_cast<double>(sums_[block]), -fraction_bits); }

  private:
    std::array<std::int64_t, BlockGrid::count> sums_{};
};

}  // namespace keyhole
