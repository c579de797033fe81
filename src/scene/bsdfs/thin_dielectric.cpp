#include "scene/bsdfs.h"
#include "scene/bsdfs/specular_pair.h"

namespace keyhole {
namespace {

// A thin pane: two parallel boundaries so close that light leaves where it entered and goes straight on.
class ThinDielectric final : public SpecularPair {
  public:
    ThinDielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance)
        : SpecularPair(std::move(specular_reflectance), std::move(specular_transmittance)), eta_(eta) {}

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2&,
                                     Mode) const override {
        if (!(abs_cos_theta(w_known) > 0)) return std::nullopt;
        const Shares s = shares(w_known);
        return choose(x, w_known, s.reflected, s.transmitted, -w_known, 1, 1, u_lobe);
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3& w_known, const Vec3&, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (!(abs_cos_theta(w_known) > 0)) return std::nullopt;
        const Shares s = shares(w_known);
        return invert_choice(s.reflected, s.transmitted, event, v);
    }

    const char* name() const override { return "thindielectric"; }

  private:
    struct Shares {
        double reflected, transmitted;
    };
    // Summed over all reflections inside: R + T R T + T R^3 T + ... = 2 R / (1 + R), and T^2 + T R^2 T + ... =
    // T / (1 + R) [Stokes 1862].
    Shares shares(const Vec3& w) const {
        const DielectricFresnel f = fresnel_dielectric(abs_cos_theta(w), eta_);
        const double scale = 1 / (1 + f.reflectance);
        return {2 * f.reflectance * scale, f.transmittance * scale};
    }

    double eta_;
};

}  // namespace

BsdfPtr make_thin_dielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance) {
    return std::make_shared<ThinDielectric>(eta, std::move(specular_reflectance), std::move(specular_transmittance));
}

}  // namespace keyhole
