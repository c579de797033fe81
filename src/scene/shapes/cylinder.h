// Open cylinder, seen from both sides, its normal outward. u is the azimuth about the axis over 2 pi, v runs from p0
// to p1.
#pragma once

#include "scene/shapes/analytic_shape.h"

namespace keyhole {

class Cylinder final : public AnalyticShape {
  public:
    // `to_world` may rotate, reflect, translate and scale uniformly. Throws std::invalid_argument.
    Cylinder(const Vec3& p0, const Vec3& p1, double radius, const Affine& to_world);

  private:
    Roots roots(const Vec3& o, const Vec3& d) const override;
    bool contains(const Vec3& p) const override { return p.z() >= 0 && p.z() <= 1; }
    Point project(const Vec3& p) const override;
    Parameters parameters(const Vec3& p) const override;
    Vec3 sample_local(const Vec2& u) const override;
    Vec2 invert_local(const Vec3& p) const override;
    std::pair<Vec3, Vec3> local_bounds() const override { return {{-1, -1, 0}, {1, 1, 1}}; }
};

}  // namespace keyhole
