// Camera with a round thin lens, in focus on the plane at the focus distance (Mitsuba's `thinlens`).
#include <cmath>
#include <stdexcept>

#include "base/warp.h"
#include "scene/sensors/projection.h"

namespace keyhole {
namespace {

class ThinLens final : public Sensor {
  public:
    explicit ThinLens(const PerspectiveParams& params)
        : projection_(params), radius_(params.aperture_radius), focus_distance_(params.focus_distance) {
        if (!(radius_ > 0) || !std::isfinite(radius_)) throw std::invalid_argument("aperture_radius must be positive");
        if (!(focus_distance_ > 0) || !std::isfinite(focus_distance_))
            throw std::invalid_argument("focus_distance must be positive");
        pdf_ = square_to_disk_pdf() / sqr(radius_);
        traits_.aperture = true;
    }

    SensorPoint sample_point(const Vec2& u) const override {
        const Vec2 a = radius_ * square_to_disk(u);
        return {projection_.origin() + projection_.to_world({a.x(), a.y(), 0}), pdf_};
    }
    Vec2 invert_point(const SensorPoint& e, const Vec2&) const override {
        return disk_to_square(projection_.to_camera(e.p - projection_.origin()).head<2>() / radius_);
    }
    SensorRay ray(const SensorPoint& e, const Vec2& raster) const override {
        return projection_.ray(e.p, shift(e), raster);
    }
    std::optional<SensorView> view(const SensorPoint& e, const Vec3& x) const override {
        return projection_.view(e.p, shift(e), x, pdf_);
    }
    std::optional<Vec2> raster_towards(const SensorPoint& e, const Vec3& d) const override {
        return projection_.raster_towards(shift(e), d);
    }
    const char* name() const override { return "thinlens"; }

  private:
    Vec2 shift(const SensorPoint& e) const {
        return projection_.to_camera(e.p - projection_.origin()).head<2>() / focus_distance_;
    }

    Projection projection_;
    double radius_, focus_distance_, pdf_;
};

}  // namespace

std::unique_ptr<Sensor> make_thin_lens_sensor(const PerspectiveParams& params) {
    return std::make_unique<ThinLens>(params);
}

}  // namespace keyhole
