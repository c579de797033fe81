// Parallel projection (Mitsuba's `orthographic`): the endpoint is the fixed direction towards the sensor.
#include <cmath>
#include <stdexcept>

#include "scene/sensor.h"

namespace keyhole {
namespace {

class Orthographic final : public Sensor {
  public:
    explicit Orthographic(const OrthographicParams& params)
        : to_world_(params.to_world),
          half_width_(params.width / 2.0),
          half_height_(params.height / 2.0),
          near_clip_(params.near_clip),
          far_clip_(params.far_clip) {
        if (params.width <= 0 || params.height <= 0) throw std::invalid_argument("the film's size must be positive");
        if (!(near_clip_ < far_clip_)) throw std::invalid_argument("near_clip must be less than far_clip");
        const Eigen::Matrix3d m = to_world_.linear();
        direction_ = m.col(2).normalized();
        // Area perpendicular to the rays of the image of a unit square of the local xy plane.
        const double area = std::abs(m.col(0).cross(m.col(1)).dot(direction_));
        if (!to_world_.matrix().allFinite() || !(area > 1e-12 * m.col(0).norm() * m.col(1).norm()))
            throw std::invalid_argument("to_world of the sensor is singular");
        density_ = sqr(half_width_) / area;
        to_local_ = to_world_.inverse();
        traits_.infinite = true;
    }

    SensorPoint sample_point(const Vec2&) const override { return {-direction_, 1}; }
    Vec2 invert_point(const SensorPoint&, const Vec2& unused) const override { return unused; }
    SensorRay ray(const SensorPoint&, const Vec2& raster) const override {
        const Vec3 local((half_width_ - raster.x()) / half_width_, (half_height_ - raster.y()) / half_width_,
                         near_clip_);
        return {to_world_ * local, direction_, (far_clip_ - near_clip_) * to_world_.linear().col(2).norm(), density_};
    }
    std::optional<SensorView> view(const SensorPoint&, const Vec3& x) const override {
        const Vec3 local = to_local_ * x;
        if (!(local.z() >= near_clip_ && local.z() <= far_clip_)) return std::nullopt;
        const Vec2 raster(half_width_ - half_width_ * local.x(), half_height_ - half_width_ * local.y());
        return SensorView{raster, to_world_ * Vec3(local.x(), local.y(), near_clip_), density_, density_};
    }
    std::optional<Vec2> raster_towards(const SensorPoint&, const Vec3&) const override { return std::nullopt; }
    const char* name() const override { return "orthographic"; }

  private:
    Affine to_world_, to_local_;
    Vec3 direction_;                   // of the rays, unit
    double half_width_, half_height_;  // of the film, in pixels
    double near_clip_, far_clip_;      // in local units
    double density_;
};

}  // namespace

std::unique_ptr<Sensor> make_orthographic_sensor(const OrthographicParams& params) {
    return std::make_unique<Orthographic>(params);
}

}  // namespace keyhole
