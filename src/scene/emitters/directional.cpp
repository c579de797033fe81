// Parallel light from one direction (Mitsuba's `directional`).
#include <stdexcept>

#include "scene/emitters.h"
#include "scene/emitters/infinite.h"

namespace keyhole {
namespace {

class DirectionalEmitter final : public InfiniteEmitter {
  public:
    DirectionalEmitter(const Vec3& towards, const Spectrum& irradiance) : towards_(towards), irradiance_(irradiance) {
        traits_.delta = true;
    }

    EmitterPoint sample_point(double, const Vec2&) const override { return {towards_, Vec3::Zero(), {0, 0}, 1}; }
    std::optional<EmitterNumbers> invert_point(const EmitterPoint&, const InverseNumbers& v) const override {
        return EmitterNumbers{v.place, v.direction};
    }
    double pdf_point(const EmitterPoint&) const override { return 0; }
    Spectrum emitted(const EmitterPoint&, const Vec3&) const override { return irradiance_; }
    Spectrum radiance(const EmitterPoint&, const Vec3&) const override { return Spectrum::Zero(); }
    Spectrum power() const override { return irradiance_ * disk_area(); }
    const char* name() const override { return "directional"; }

  private:
    Vec3 towards_;  // the emitter
    Spectrum irradiance_;
};

}  // namespace

std::unique_ptr<Emitter> make_directional_emitter(const Vec3& direction, const Spectrum& irradiance) {
    if (!direction.allFinite() || !(direction.norm() > 0))
        throw std::invalid_argument("the direction of the emitter must not be zero");
    return std::make_unique<DirectionalEmitter>(-direction.normalized(), irradiance);
}

}  // namespace keyhole
