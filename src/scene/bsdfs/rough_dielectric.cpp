// Rough dielectric boundary: single reflection or refraction at the facets [Walter et al. 2007, eq. 19-21].
#include "base/error.h"
#include "scene/bsdfs/lobe_choice.h"
#include "scene/fresnel.h"
#include "scene/microfacet.h"

namespace keyhole {
namespace {

enum Lobe : std::uint8_t { reflection, transmission };

class RoughDielectric final : public Bsdf {
  public:
    RoughDielectric(const Roughness& roughness, double eta, ColorInput reflectance, ColorInput transmittance)
        : roughness_(roughness),
          eta_(eta),
          reflectance_(std::move(reflectance)),
          transmittance_(std::move(transmittance)) {
        traits_.smooth = traits_.transmissive = traits_.chooses_lobe = true;
        traits_.lobes = 2;
        traits_.needs_uv = roughness_.textured() || reflectance_.texture || transmittance_.texture;
        traits_.needs_tangents = roughness_.anisotropic();
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        const double sides = w_eye.z() * w_light.z();
        if (sides > 0) return eval_reflection(x, w_eye, w_light);
        if (sides < 0) return eval_transmission(x, w_eye, w_light);
        return {Spectrum::Zero(), 0, 0};
    }

    // The facet normal first, then reflection with the probability of its Fresnel reflectance.
    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode mode) const override {
        if (w_known.z() == 0) return {};
        const Vec3 above = w_known.z() > 0 ? w_known : Vec3(-w_known);
        const double eta = w_known.z() > 0 ? eta_ : 1 / eta_;
        const Microfacet microfacet = roughness_.at(x.uv);
        const Vec3 m = microfacet.sample_visible(above, u);
        const double cos_m = std::min(above.dot(m), 1.0);
        if (!(cos_m > 0)) return {};
        const DielectricFresnel fresnel = fresnel_dielectric(cos_m, eta);
        const double d = microfacet.density(m), area = microfacet.projected_area(w_known);
        BsdfSample s;
        if (u_lobe < fresnel.reflectance) {
            s.lobe = reflection;
            s.w = reflect(w_known, m);
            if (!(s.w.z() * w_known.z() > 0)) return {};
            const double area_other = microfacet.projected_area(s.w), density = 0.25 * fresnel.reflectance * d;
            s.pdf = density / area;
            s.pdf_reverse = density / area_other;
            s.weight = reflectance_(x.uv) * (std::abs(s.w.z()) / area_other);
            return s;
        }
        s.lobe = transmission;
        s.eta = eta;
        s.w = refract(w_known, m, fresnel.cos_t, eta);
        if (!(s.w.z() * w_known.z() < 0 && fresnel.cos_t > 0)) return {};
        // |w_known + eta w| without the cancellation of (cos - eta cos_t).
        const double h = (eta - 1) * (eta + 1) / (cos_m + eta * fresnel.cos_t);
        const double density = fresnel.transmittance * d * cos_m * fresnel.cos_t / (h * h);
        const double area_other = microfacet.projected_area(s.w);
        s.pdf = density * eta * eta / area;
        s.pdf_reverse = density / area_other;
        const double radiance_scale = mode == Mode::eye ? 1 / (eta * eta) : 1;
        s.weight = transmittance_(x.uv) * (std::abs(s.w.z()) / area_other * radiance_scale);
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        const double sides = w_known.z() * w.z();
        if (event.delta || sides == 0) return {};
        const double eta = w_known.z() > 0 ? eta_ : 1 / eta_;
        const Vec3 above = w_known.z() > 0 ? w_known : Vec3(-w_known);
        const Vec3 h = sides > 0 ? Vec3(w_known + w) : Vec3(w_known + eta * w);
        const Vec3 m = h * (std::copysign(1.0, h.z()) / h.norm());
        const double cos_m = std::min(above.dot(m), 1.0);
        if (!(cos_m > 0) || !(std::copysign(1.0, w.z()) * w.dot(m) > 0)) return {};
        const double p = fresnel_dielectric(cos_m, eta).reflectance;
        const Microfacet microfacet = roughness_.at(x.uv);
        if (!((sides > 0 ? p : 1 - p) > 0 && microfacet.density(m) > 0)) return {};
        return BsdfNumbers{lobe_number(sides > 0, p, v.place), microfacet.visible_to_square(above, m)};
    }

    const char* name() const override { return "roughdielectric"; }

  private:
    BsdfValue eval_reflection(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const {
        const FacetReflection r = facet_reflection(roughness_.at(x.uv), w_eye, w_light);
        const double f = fresnel_dielectric(std::min(r.cos_m, 1.0), w_eye.z() > 0 ? eta_ : 1 / eta_).reflectance;
        return {reflectance_(x.uv) * (f * r.value), f * r.pdf_light, f * r.pdf_eye};
    }

    BsdfValue eval_transmission(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const {
        const double n_eye = w_eye.z() > 0 ? 1 : eta_, n_light = w_light.z() > 0 ? 1 : eta_;
        const Vec3 h = n_eye * w_eye + n_light * w_light;
        const double hh = h.squaredNorm();
        const Vec3 m = h * (std::copysign(1.0, h.z()) / std::sqrt(hh));
        // Positive where a direction faces the same side of the facet as of the surface.
        const double cos_eye = std::copysign(1.0, w_eye.z()) * w_eye.dot(m);
        const double cos_light = std::copysign(1.0, w_light.z()) * w_light.dot(m);
        if (!(hh > 0 && cos_eye > 0 && cos_light > 0)) return {Spectrum::Zero(), 0, 0};
        // Seen from the thinner side, where no angle is critical; the transmittance is the same from both.
        const double cos_thin = n_eye < n_light ? cos_eye : cos_light;
        const double t = fresnel_dielectric(std::min(cos_thin, 1.0), std::max(eta_, 1 / eta_)).transmittance;
        const Microfacet microfacet = roughness_.at(x.uv);
        const double density = t * microfacet.density(m) * cos_eye * cos_light / hh;
        const double inv_eye = 1 / microfacet.projected_area(w_eye);
        const double inv_light = 1 / microfacet.projected_area(w_light);
        return {transmittance_(x.uv) * (density * inv_eye * inv_light * n_eye * n_eye),
                density * inv_eye * n_light * n_light, density * inv_light * n_eye * n_eye};
    }

    Roughness roughness_;
    double eta_;
    ColorInput reflectance_, transmittance_;
};

}  // namespace

BsdfPtr make_rough_dielectric(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v, double eta,
                              ColorInput specular_reflectance, ColorInput specular_transmittance) {
    // Without a change of index all light passes straight on, and no facet normal belongs to a pair of directions.
    if (!(eta > 0) || eta == 1)
        throw InputError({}, "a rough dielectric needs indices of refraction that are positive and differ");
    return std::make_shared<RoughDielectric>(Roughness(type, std::move(alpha_u), std::move(alpha_v)), eta,
                                             std::move(specular_reflectance), std::move(specular_transmittance));
}

}  // namespace keyhole
