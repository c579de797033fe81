// Pinhole camera (Mitsuba's `perspective`).
#include "scene/sensors/projection.h"

namespace keyhole {
namespace {

class Perspective final : public Sensor {
  public:
    explicit Perspective(const PerspectiveParams& params) : projection_(params) {}

    SensorPoint sample_point(const Vec2&) const override { return {projection_.origin(), 1}; }
    Vec2 invert_point(const SensorPoint&, const Vec2& unused) const override { return unused; }
    SensorRay ray(const SensorPoint& e, const Vec2& raster) const override {
        return projection_.ray(e.p, {0, 0}, raster);
    }
    std::optional<SensorView> view(const SensorPoint& e, const Vec3& x) const override {
        return projection_.view(e.p, {0, 0}, x, 1);
    }
    std::optional<Vec2> raster_towards(const SensorPoint&, const Vec3& d) const override {
        return projection_.raster_towards({0, 0}, d);
    }
    const char* name() const override { return "perspective"; }

  private:
    Projection projection_;
};

}  // namespace

std::unique_ptr<Sensor> make_perspective_sensor(const PerspectiveParams& params) {
    return std::make_unique<Perspective>(params);
}

}  // namespace keyhole
