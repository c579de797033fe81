// Rough plastic: a rough dielectric coat over a diffuse base. What enters through the coat is scattered by the base,
// inside any number of times, and leaves through the coat:
//     f = F D G / (4 cos cos) + T(cos w_eye) T(cos w_light) / (pi eta^2) * a / (1 - a R_i)
// with the base's reflectance `a`, the coat's transmittance T and its internal diffuse reflectance R_i. The linear
// version divides by (1 - R_i) instead and so keeps the colour of the base.
#include "base/error.h"
#include "base/warp.h"
#include "scene/bsdfs/lobe_choice.h"
#include "scene/bsdfs/rough_transmittance.h"
#include "scene/fresnel.h"
#include "scene/microfacet.h"

namespace keyhole {
namespace {

enum Lobe : std::uint8_t { coat, base };

class RoughPlastic final : public Bsdf {
  public:
    RoughPlastic(MicrofacetType type, double alpha, double eta, ColorInput diffuse, ColorInput specular, bool nonlinear)
        : microfacet_(type, alpha, alpha),
          eta_(eta),
          transmittance_(rough_transmittance(type, alpha, eta)),
          diffuse_(std::move(diffuse)),
          specular_(std::move(specular)),
          nonlinear_(nonlinear) {
        traits_.smooth = traits_.chooses_lobe = true;
        traits_.lobes = 2;
        traits_.needs_uv = diffuse_.texture || specular_.texture;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (!(w_eye.z() > 0 && w_light.z() > 0)) return {Spectrum::Zero(), 0, 0};
        return eval(Layers{diffuse_(x.uv), specular_(x.uv)}, w_eye, w_light);
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode) const override {
        if (!(w_known.z() > 0)) return {};
        const Layers layers{diffuse_(x.uv), specular_(x.uv)};
        BsdfSample s;
        s.lobe = u_lobe < layers.coat_probability((*transmittance_)(w_known.z())) ? coat : base;
        s.w =
            s.lobe == coat ? reflect(w_known, microfacet_.sample_visible(w_known, u)) : square_to_cosine_hemisphere(u);
        if (!(s.w.z() > 0)) return {};
        const BsdfValue value = eval(layers, w_known, s.w);
        s.pdf = value.pdf_light;
        s.pdf_reverse = value.pdf_eye;
        if (!(s.pdf > 0)) return {};
        s.weight = value.f * (s.w.z() / s.pdf);
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (event.delta || !(w_known.z() > 0 && w.z() > 0)) return {};
        const double p = Layers{diffuse_(x.uv), specular_(x.uv)}.coat_probability((*transmittance_)(w_known.z()));
        const double of_coat = p * facet_reflection(microfacet_, w_known, w).pdf_light;
        const double of_base = (1 - p) * square_to_cosine_hemisphere_pdf(w);
        if (!(of_coat + of_base > 0)) return {};
        const bool at_coat = v.branch < share(of_coat, of_base);
        return BsdfNumbers{lobe_number(at_coat, p, v.place),
                           at_coat ? microfacet_.visible_to_square(w_known, (w_known + w).normalized())
                                   : cosine_hemisphere_to_square(w)};
    }

    const char* name() const override { return "roughplastic"; }

  private:
    struct Layers {
        Spectrum diffuse, specular;

        // By the expected albedos of the two lobes; 1 where both are black (f is zero there).
        double coat_probability(double transmittance) const {
            const double coat_weight = (1 - transmittance) * luminance(specular);
            const double base_weight = transmittance * luminance(diffuse);
            return base_weight > 0 ? coat_weight / (coat_weight + base_weight) : 1;
        }
    };

    // Both directions above the surface.
    BsdfValue eval(const Layers& layers, const Vec3& w_eye, const Vec3& w_light) const {
        const double t_eye = (*transmittance_)(w_eye.z()), t_light = (*transmittance_)(w_light.z());
        const double coat_eye = layers.coat_probability(t_eye), coat_light = layers.coat_probability(t_light);
        const FacetReflection r = facet_reflection(microfacet_, w_eye, w_light);
        const double fresnel = fresnel_dielectric(std::min(r.cos_m, 1.0), eta_).reflectance;
        const double internal = transmittance_->internal_diffuse_reflectance();
        const Spectrum base_reflectance =
            nonlinear_ ? Spectrum(layers.diffuse / (1 - layers.diffuse * internal)) : layers.diffuse / (1 - internal);
        return {layers.specular * (fresnel * r.value) + base_reflectance * (t_eye * t_light * inv_pi / (eta_ * eta_)),
                coat_eye * r.pdf_light + (1 - coat_eye) * w_light.z() * inv_pi,
                coat_light * r.pdf_eye + (1 - coat_light) * w_eye.z() * inv_pi};
    }

    Microfacet microfacet_;
    double eta_;
    std::shared_ptr<const RoughTransmittance> transmittance_;
    ColorInput diffuse_, specular_;
    bool nonlinear_;
};

}  // namespace

BsdfPtr make_rough_plastic(MicrofacetType type, double alpha, double eta, ColorInput diffuse_reflectance,
                           ColorInput specular_reflectance, bool nonlinear) {
    if (!(eta > 0)) throw InputError({}, "a rough plastic needs positive indices of refraction");
    return std::make_shared<RoughPlastic>(type, alpha, eta, std::move(diffuse_reflectance),
                                          std::move(specular_reflectance), nonlinear);
}

}  // namespace keyhole
