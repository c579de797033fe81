// The light of a grid of blocks of the image.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pathspace/subpath.h"

namespace keyhole {

// side x side equal blocks of the window that paths are sampled in, row by row from the top.
class BlockGrid {
  public:
    static constexpr int usual_side = 16;

    explicit BlockGrid(const RasterWindow& window, int side = usual_side)
        : side_(side), origin_(window.origin), scale_(Vec2(side, side).cwiseQuotient(window.size)) {}

    std::size_t count() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }

    // The block of a position in the window.
    int index(const Vec2& raster) const {
        const auto cell = [this](double x) { return std::min(static_cast<int>(x), side_ - 1); };
        return cell((raster.y() - origin_.y()) * scale_.y()) * side_ + cell((raster.x() - origin_.x()) * scale_.x());
    }

  private:
    int side_;
    Vec2 origin_, scale_;
};

// Sums of weighted luminance by block, without a reconstruction filter. Fixed-point integers: the same in any order.
class BlockSums {
  public:
    static constexpr int fraction_bits = 24;

    explicit BlockSums(std::size_t blocks) : sums_(blocks) {}

    std::size_t size() const { return sums_.size(); }
    void add(int block, double value) {
        sums_[static_cast<std::size_t>(block)] += std::llrint(value * (std::int64_t{1} << fraction_bits));
    }
    BlockSums& operator+=(const BlockSums& other) {
        for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
        return *this;
    }
    void clear() { std::fill(sums_.begin(), sums_.end(), 0); }
    double operator[](std::size_t block) const { return std::ldexp(static_cast<double>(sums_[block]), -fraction_bits); }

  private:
    std::vector<std::int64_t> sums_;
};

}  // namespace keyhole
