// A point that emits evenly in all directions (Mitsuba's `point`).
#include "base/warp.h"
#include "scene/emitters.h"
#include "scene/emitters/delta_position.h"

namespace keyhole {
namespace {

class PointEmitter final : public DeltaPositionEmitter {
  public:
    PointEmitter(const Vec3& position, const Spectrum& intensity)
        : DeltaPositionEmitter(position), intensity_(intensity) {}

    EmissionRay sample_ray(const EmitterPoint& e, const Vec2& u) const override {
        return {e.p, square_to_sphere(u), square_to_sphere_pdf()};
    }
    std::optional<Vec2> invert_ray(const EmitterPoint& e, const Vec3& x) const override {
        return sphere_to_square((x - e.p).normalized());
    }
    double pdf_ray(const EmitterPoint&, const Vec3&) const override { return square_to_sphere_pdf(); }
    Spectrum emitted(const EmitterPoint&, const Vec3&) const override { return intensity_; }
    Spectrum power() const override { return 4 * pi * intensity_; }
    const char* name() const override { return "point"; }

  private:
    Spectrum intensity_;
};

}  // namespace

std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Spectrum& intensity) {
    return std::make_unique<PointEmitter>(position, intensity);
}

}  // namespace keyhole
