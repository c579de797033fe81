// Disk. u is the radius, v the azimuth over 2 pi. Any invertible affine transform makes an ellipse of it.
#pragma once

#include "scene/shapes/analytic_shape.h"

namespace keyhole {

class Disk final : public AnalyticShape {
  public:
    explicit Disk(const Affine& to_world);  // throws std::invalid_argument for a singular transform

  private:
    Roots roots(const Vec3& o, const Vec3& d) const override;
    bool contains(const Vec3& p) const override { return p.x() * p.x() + p.y() * p.y() <= 1; }
    Point project(const Vec3& p) const override;
    Parameters parameters(const Vec3& p) const override;
    Vec3 sample_local(const Vec2& u) const override;
    Vec2 invert_local(const Vec3& p) const override;
    std::pair<Vec3, Vec3> local_bounds() const override { return {{-1, -1, 0}, {1, 1, 0}}; }
};

}  // namespace keyhole
