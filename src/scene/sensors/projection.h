// The core of the pinhole and the thin-lens camera: between raster positions, points and rays from a point of the
// aperture.
//
// In camera space (looking along +z) a raster position stands for a point (x, y, 1) of the image plane; the ray from
// the aperture point (a, 0) to it passes through the focus point at distance f, so its direction is
// (x - a_x / f, y - a_y / f, 1). A pinhole has a = 0. With K = raster area per area of the image plane and theta the
// angle of the ray with the axis, d omega = cos^3(theta) dA_image for every a (the focus plane's dA = f^2 dA_image,
// seen from distance f / cos(theta)), so raster area per solid angle is K / cos^3(theta) in both cameras.
#pragma once

#include <optional>

#include "scene/orthogonal.h"
#include "scene/sensor.h"

namespace keyhole {

class Projection {
  public:
    // Throws std::invalid_argument for parameters out of their range.
    explicit Projection(const PerspectiveParams& params);

    const Vec3& origin() const { return origin_; }
    Vec3 to_world(const Vec3& v) const { return rotation_ * v; }
    Vec3 to_camera(const Vec3& v) const { return rotation_.transpose() * v; }

    // `p` is a point of the aperture and `shift` = a / f, its place in camera space over the focus distance.
    SensorRay ray(const Vec3& p, const Vec2& shift, const Vec2& raster) const {
        const Vec2 image = (center_ - raster) / pixels_;
        const Vec3 d = to_world({image.x() - shift.x(), image.y() - shift.y(), 1});
        const double inv_cos = d.norm();
        return {p + d * near_clip_, d / inv_cos, (far_clip_ - near_clip_) * inv_cos,
                sqr(pixels_) * inv_cos * inv_cos * inv_cos};
    }

    std::optional<SensorView> view(const Vec3& p, const Vec2& shift, const Vec3& x, double aperture_pdf) const {
        const Vec3 to_x = x - p, d = to_camera(to_x);
        if (!(d.z() >= near_clip_ && d.z() <= far_clip_)) return std::nullopt;
        const double inv_z = 1 / d.z(), inv_cos = d.norm() * inv_z;
        const Vec2 image(d.x() * inv_z + shift.x(), d.y() * inv_z + shift.y());
        const double density = sqr(pixels_) * inv_cos * inv_cos * inv_cos;
        return SensorView{center_ - pixels_ * image, p + to_x * (near_clip_ * inv_z), density * aperture_pdf, density};
    }

    std::optional<Vec2> raster_towards(const Vec2& shift, const Vec3& direction) const {
        const Vec3 d = to_camera(direction);
        if (!(d.z() > 0)) return std::nullopt;
        return center_ - pixels_ * (d.head<2>() / d.z() + shift);
    }

  private:
    Matrix3 rotation_;
    Vec3 origin_;
    Vec2 center_;    // raster position of the optical axis
    double pixels_;  // per unit length of the image plane z = 1
    double near_clip_, far_clip_;
};

}  // namespace keyhole
