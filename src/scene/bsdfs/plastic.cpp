#include "base/warp.h"
#include "scene/bsdfs.h"
#include "scene/bsdfs/lobe_choice.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

// A smooth dielectric coat over a diffuse base, on the +z side: delta reflection (lobe 0) and what the base scatters
// back through the coat (lobe 1), with all reflections in between summed up.
class Plastic final : public Bsdf {
  public:
    Plastic(double eta, ColorInput diffuse_reflectance, ColorInput specular_reflectance, bool nonlinear)
        : diffuse_(std::move(diffuse_reflectance)),
          specular_(std::move(specular_reflectance)),
          nonlinear_(nonlinear),
          eta_(eta),
          inv_eta2_(1 / (eta * eta)),
          internal_(fresnel_diffuse_reflectance(1 / eta)),
          specular_power_(luminance(specular_.mean())),
          diffuse_power_(luminance(diffuse_.mean())) {
        traits_.smooth = diffuse_power_ > 0;
        traits_.delta = specular_power_ > 0;
        traits_.chooses_lobe = traits_.smooth && traits_.delta;
        traits_.needs_uv = diffuse_.texture || specular_.texture;
        traits_.lobes = 2;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (!(w_eye.z() > 0 && w_light.z() > 0 && traits_.smooth)) return {Spectrum::Zero(), 0, 0};
        const DielectricFresnel at_eye = fresnel_dielectric(w_eye.z(), eta_);
        const DielectricFresnel at_light = fresnel_dielectric(w_light.z(), eta_);
        return {base_f(x) * (at_eye.transmittance * at_light.transmittance),
                diffuse_probability(at_eye) * w_light.z() * inv_pi, diffuse_probability(at_light) * w_eye.z() * inv_pi};
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode) const override {
        if (!(w_known.z() > 0)) return std::nullopt;
        const DielectricFresnel fresnel = fresnel_dielectric(w_known.z(), eta_);
        if (!(specular_power(fresnel) + diffuse_power(fresnel) > 0)) return std::nullopt;
        const double p = share(specular_power(fresnel), diffuse_power(fresnel));
        if (u_lobe < p) {  // the mirror direction sees the same Fresnel term: both probabilities are p
            const Spectrum weight = specular_(x.uv) * (fresnel.reflectance / p);
            return BsdfSample{reflect(w_known), weight, p, p, 1, 0, true};
        }
        const Vec3 w = square_to_cosine_hemisphere(u);
        if (!(w.z() > 0)) return std::nullopt;
        const DielectricFresnel at_w = fresnel_dielectric(w.z(), eta_);
        const double probability = diffuse_probability(fresnel);
        const Spectrum weight = base_f(x) * (pi * fresnel.transmittance * at_w.transmittance / probability);
        return BsdfSample{w, weight, probability * w.z() * inv_pi, diffuse_probability(at_w) * w_known.z() * inv_pi, 1,
                          1, false};
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (!(w_known.z() > 0 && w.z() > 0)) return std::nullopt;
        const DielectricFresnel fresnel = fresnel_dielectric(w_known.z(), eta_);
        const double specular = specular_power(fresnel), diffuse = diffuse_power(fresnel);
        if (!((event.delta ? specular : diffuse) > 0)) return std::nullopt;
        const double p = share(specular, diffuse);
        return BsdfNumbers{lobe_number(event.delta, p, v.place),
                           event.delta ? v.direction : cosine_hemisphere_to_square(w)};
    }

    const char* name() const override { return "plastic"; }

  private:
    // f without the two transmittances of the coat. Light that the coat throws back into the base is scattered again;
    // its colour shifts with every turn where `nonlinear`, else the series is summed as for a white base.
    Spectrum base_f(const SurfacePoint& x) const {
        const Spectrum base = diffuse_(x.uv);
        const double scale = inv_eta2_ * inv_pi;
        if (nonlinear_) return base * scale / (1 - base * internal_);
        return base * (scale / (1 - internal_));
    }

    // Lobes are chosen in proportion to these, seen from one direction alone.
    double specular_power(const DielectricFresnel& f) const { return f.reflectance * specular_power_; }
    double diffuse_power(const DielectricFresnel& f) const { return f.transmittance * diffuse_power_; }
    double diffuse_probability(const DielectricFresnel& f) const { return share(diffuse_power(f), specular_power(f)); }

    ColorInput diffuse_, specular_;
    bool nonlinear_;
    double eta_, inv_eta2_;
    double internal_;  // diffuse light from the base that the coat reflects back
    double specular_power_, diffuse_power_;
};

}  // namespace

BsdfPtr make_plastic(double eta, ColorInput diffuse_reflectance, ColorInput specular_reflectance, bool nonlinear) {
    return std::make_shared<Plastic>(eta, std::move(diffuse_reflectance), std::move(specular_reflectance), nonlinear);
}

}  // namespace keyhole
