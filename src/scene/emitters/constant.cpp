// The same radiance from every direction (Mitsuba's `constant`).
#include "scene/emitters.h"
#include "scene/emitters/infinite.h"

namespace keyhole {
namespace {

class ConstantEmitter final : public InfiniteEmitter {
  public:
    explicit ConstantEmitter(const Spectrum& radiance) : radiance_(radiance) { traits_.environment = true; }

    EmitterPoint sample_point(double, const Vec2& u) const override {
        return {square_to_sphere(u), Vec3::Zero(), {0, 0}, square_to_sphere_pdf()};
    }
    std::optional<EmitterNumbers> invert_point(const EmitterPoint& e, const InverseNumbers& v) const override {
        return EmitterNumbers{v.place, sphere_to_square(e.p)};
    }
    double pdf_point(const EmitterPoint&) const override { return square_to_sphere_pdf(); }
    Spectrum emitted(const EmitterPoint&, const Vec3&) const override { return radiance_; }
    Spectrum radiance(const EmitterPoint&, const Vec3&) const override { return radiance_; }
    Spectrum power() const override { return radiance_ * (4 * pi * disk_area()); }
    const char* name() const override { return "constant"; }

  private:
    Spectrum radiance_;
};

}  // namespace

std::unique_ptr<Emitter> make_constant_emitter(const Spectrum& radiance) {
    return std::make_unique<ConstantEmitter>(radiance);
}

}  // namespace keyhole
