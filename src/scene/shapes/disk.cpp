#include "scene/shapes/disk.h"

#include <cmath>

#include "base/warp.h"

namespace keyhole {

Disk::Disk(const Affine& to_world) {
    check_invertible(to_world, "disk");
    set_transform(to_world, pi * to_world.linear().col(0).cross(to_world.linear().col(1)).norm());
}

AnalyticShape::Roots Disk::roots(const Vec3& o, const Vec3& d) const {
    if (d.z() == 0) return {};
    const double t = -o.z() / d.z();
    return {{t, t}, 1, true};
}

AnalyticShape::Point Disk::project(const Vec3& p) const { return {{p.x(), p.y(), 0}, {0, 0, 1}}; }

AnalyticShape::Parameters Disk::parameters(const Vec3& p) const {
    const double r = std::hypot(p.x(), p.y());
    const double cos_phi = r > 0 ? p.x() / r : 1, sin_phi = r > 0 ? p.y() / r : 0;
    return {{r, azimuth_to_unit(p.x(), p.y())}, {cos_phi, sin_phi, 0}, {-2 * pi * p.y(), 2 * pi * p.x(), 0}};
}

Vec3 Disk::sample_local(const Vec2& u) const {
    const Vec2 p = square_to_disk(u);
    return {p.x(), p.y(), 0};
}

Vec2 Disk::invert_local(const Vec3& p) const { return disk_to_square(p.head<2>()); }

}  // namespace keyhole
