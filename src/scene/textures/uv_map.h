// From surface parameters to texture space, the same for every texture.
#pragma once

#include "base/vec.h"

namespace keyhole {

// (u, v) -> to_uv (u, 1 - v): in texture space y points down, with y = 0 the top of an image. It is what Mitsuba does
// for OBJ meshes, whose v it flips when reading them.
class UvMap {
  public:
    explicit UvMap(const Eigen::Matrix3d& to_uv) : linear_(to_uv.topLeftCorner<2, 2>()) {
        linear_.col(1) *= -1;
        offset_ = to_uv.topRightCorner<2, 1>() + to_uv.block<2, 1>(0, 1);
    }

    Vec2 operator()(const Vec2& uv) const { return linear_ * uv + offset_; }

    // A gradient in texture space as a gradient in (u, v).
    Vec2 pull_back(const Vec2& gradient) const { return linear_.transpose() * gradient; }

  private:
    Eigen::Matrix<double, 2, 2, Eigen::DontAlign> linear_;
    Vec2 offset_;
};

}  // namespace keyhole
