// Rough conductor: single reflection at the facets of a metal [Walter et al. 2007, eq. 20].
#include "scene/fresnel.h"
#include "scene/microfacet.h"

namespace keyhole {
namespace {

class RoughConductor final : public Bsdf {
  public:
    RoughConductor(const Roughness& roughness, const ConductorIor& ior, ColorInput reflectance)
        : roughness_(roughness), ior_(ior), reflectance_(std::move(reflectance)) {
        traits_.smooth = true;
        traits_.needs_uv = roughness_.textured() || reflectance_.texture;
        traits_.needs_tangents = roughness_.anisotropic();
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (!(w_eye.z() > 0 && w_light.z() > 0)) return {Spectrum::Zero(), 0, 0};
        const FacetReflection r = facet_reflection(roughness_.at(x.uv), w_eye, w_light);
        return {fresnel(x, r.cos_m) * r.value, r.pdf_light, r.pdf_eye};
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double, const Vec2& u,
                                     Mode) const override {
        if (!(w_known.z() > 0)) return {};
        const Microfacet microfacet = roughness_.at(x.uv);
        const Vec3 m = microfacet.sample_visible(w_known, u);
        BsdfSample s;
        const double cos_m = w_known.dot(m);
        s.w = 2 * cos_m * m - w_known;
        if (!(s.w.z() > 0 && cos_m > 0)) return {};
        const double d = 0.25 * microfacet.density(m);
        s.pdf = d / microfacet.projected_area(w_known);
        s.pdf_reverse = d / microfacet.projected_area(s.w);
        s.weight = fresnel(x, cos_m) * microfacet.g1(s.w);
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (event.delta || !(w_known.z() > 0 && w.z() > 0)) return {};
        const Microfacet microfacet = roughness_.at(x.uv);
        const Vec3 m = (w_known + w).normalized();
        if (!(microfacet.density(m) > 0)) return {};
        return BsdfNumbers{v.place, microfacet.visible_to_square(w_known, m)};
    }

    const char* name() const override { return "roughconductor"; }

  private:
    Spectrum fresnel(const SurfacePoint& x, double cos_m) const {
        return fresnel_conductor(std::min(cos_m, 1.0), ior_.eta, ior_.k) * reflectance_(x.uv);
    }

    Roughness roughness_;
    ConductorIor ior_;
    ColorInput reflectance_;
};

}  // namespace

BsdfPtr make_rough_conductor(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v, const ConductorIor& ior,
                             ColorInput specular_reflectance) {
    return std::make_shared<RoughConductor>(Roughness(type, std::move(alpha_u), std::move(alpha_v)), ior,
                                            std::move(specular_reflectance));
}

}  // namespace keyhole
