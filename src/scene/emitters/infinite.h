// What the emitters at infinity share: rays start on a disk that covers the scene, perpendicular to their direction.
#pragma once

#include "base/frame.h"
#include "base/warp.h"
#include "scene/emitter.h"

namespace keyhole {

class InfiniteEmitter : public Emitter {
  public:
    InfiniteEmitter() { traits_.infinite = true; }

    EmissionRay sample_ray(const EmitterPoint& e, const Vec2& u) const final {
        const Vec2 q = square_to_disk(u);
        // The disk stays clear of the sphere, also after rounding to float.
        const Vec3 o = Frame::from_normal(e.p).to_world({q.x(), q.y(), 1.1});
        return {center_ + radius_ * o, -e.p, 1 / disk_area()};
    }
    std::optional<Vec2> invert_ray(const EmitterPoint& e, const Vec3& x) const final {
        const Vec3 q = Frame::from_normal(e.p).to_local(x - center_) / radius_;
        if (!(q.head<2>().squaredNorm() <= 1 + 1e-12)) return std::nullopt;  // 1, after rounding
        return disk_to_square(q.head<2>());
    }
    double pdf_ray(const EmitterPoint&, const Vec3&) const final { return 1 / disk_area(); }

    // A scene without extent counts as a unit sphere.
    void set_scene_bounds(const Vec3& center, double radius) final {
        center_ = center;
        radius_ = radius > 0 ? radius : 1;
    }

  protected:
    double disk_area() const { return pi * sqr(radius_); }

  private:
    Vec3 center_{0, 0, 0};
    double radius_ = 1;
};

}  // namespace keyhole
