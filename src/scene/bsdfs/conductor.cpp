#include "scene/bsdfs.h"
#include "scene/bsdfs/delta.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

// Mirror reflection off metal, on the +z side.
class Conductor final : public DeltaBsdf {
  public:
    Conductor(const ConductorIor& ior, ColorInput specular_reflectance)
        : ior_(ior), reflectance_(std::move(specular_reflectance)), perfect_((ior.eta == 0).all()) {
        traits_.needs_uv = reflectance_.texture != nullptr;
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double, const Vec2&,
                                     Mode) const override {
        if (!(w_known.z() > 0)) return std::nullopt;
        Spectrum weight = reflectance_(x.uv);
        if (!perfect_) weight *= fresnel_conductor(w_known.z(), ior_.eta, ior_.k);
        return delta_sample(reflect(w_known), weight, 1);
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3& w_known, const Vec3&, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (!event.delta || !(w_known.z() > 0)) return std::nullopt;
        return BsdfNumbers{v.place, v.direction};
    }

    const char* name() const override { return "conductor"; }

  private:
    ConductorIor ior_;
    ColorInput reflectance_;
    bool perfect_;  // reflects all light at every angle
};

}  // namespace

BsdfPtr make_conductor(const ConductorIor& ior, ColorInput specular_reflectance) {
    return std::make_shared<Conductor>(ior, std::move(specular_reflectance));
}

}  // namespace keyhole
