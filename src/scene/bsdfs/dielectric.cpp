#include "scene/bsdfs.h"
#include "scene/bsdfs/specular_pair.h"

namespace keyhole {
namespace {

// Smooth boundary between two transparent media; the exterior is on the +z side.
class Dielectric final : public SpecularPair {
  public:
    Dielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance)
        : SpecularPair(std::move(specular_reflectance), std::move(specular_transmittance)),
          eta_(eta),
          inv_eta_(1 / eta) {}

    // A bundle of rays that refracts into the medium of relative index `eta` narrows by eta^2 in solid angle, and its
    // radiance grows by as much; importance is a power and does not [Veach 1997, 5.2].
    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2&,
                                     Mode mode) const override {
        if (!(abs_cos_theta(w_known) > 0)) return std::nullopt;
        const double eta = eta_from(w_known), inv_eta = w_known.z() > 0 ? inv_eta_ : eta_;
        const DielectricFresnel f = fresnel_dielectric(abs_cos_theta(w_known), eta);
        const double radiance_scale = mode == Mode::eye ? inv_eta * inv_eta : 1;
        return choose(x, w_known, f.reflectance, f.transmittance, refract(w_known, f.cos_t, eta), eta, radiance_scale,
                      u_lobe);
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3& w_known, const Vec3&, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (!(abs_cos_theta(w_known) > 0)) return std::nullopt;
        const DielectricFresnel f = fresnel_dielectric(abs_cos_theta(w_known), eta_from(w_known));
        return invert_choice(f.reflectance, f.transmittance, event, v);
    }

    const char* name() const override { return "dielectric"; }

  private:
    double eta_from(const Vec3& w) const { return w.z() > 0 ? eta_ : inv_eta_; }

    double eta_, inv_eta_;
};

}  // namespace

BsdfPtr make_dielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance) {
    return std::make_shared<Dielectric>(eta, std::move(specular_reflectance), std::move(specular_transmittance));
}

}  // namespace keyhole
