// Base of the smooth dielectrics: a delta reflection and a delta transmission, chosen by Fresnel's equations.
#pragma once

#include "scene/bsdfs/delta.h"
#include "scene/bsdfs/lobe_choice.h"
#include "scene/fresnel.h"

namespace keyhole {

class SpecularPair : public DeltaBsdf {
  public:
    SpecularPair(ColorInput specular_reflectance, ColorInput specular_transmittance)
        : reflectance_(std::move(specular_reflectance)),
          transmittance_(std::move(specular_transmittance)),
          reflection_power_(luminance(reflectance_.mean())),
          transmission_power_(luminance(transmittance_.mean())) {
        traits_.transmissive = transmission_power_ > 0;
        traits_.chooses_lobe = transmission_power_ > 0 && reflection_power_ > 0;
        traits_.needs_uv = reflectance_.texture || transmittance_.texture;
        traits_.lobes = 2;
    }

  protected:
    // Lobe 0 reflects the share `reflected`; lobe 1 sends the share `transmitted` to `w_transmitted`, scaled by
    // `radiance_scale`. They are chosen in proportion to the shares times the mean colours. Both ends of the path see
    // the same shares, so the probabilities are the same too.
    std::optional<BsdfSample> choose(const SurfacePoint& x, const Vec3& w_known, double reflected, double transmitted,
                                     const Vec3& w_transmitted, double eta, double radiance_scale,
                                     double u_lobe) const {
        const double reflection = reflected * reflection_power_, transmission = transmitted * transmission_power_;
        if (!(reflection + transmission > 0)) return std::nullopt;
        const double p = share(reflection, transmission);
        if (u_lobe < p) return delta_sample(reflect(w_known), reflectance_(x.uv) * (reflected / p), p);
        const double q = share(transmission, reflection);
        return delta_sample(w_transmitted, transmittance_(x.uv) * (transmitted * radiance_scale / q), q, eta, 1);
    }

    // The inverse: a number by which choose() takes the lobe of the event.
    std::optional<BsdfNumbers> invert_choice(double reflected, double transmitted, const BsdfEvent& event,
                                             const InverseNumbers& v) const {
        const double reflection = reflected * reflection_power_, transmission = transmitted * transmission_power_;
        if (!event.delta || !((event.lobe == 0 ? reflection : transmission) > 0)) return std::nullopt;
        const double p = share(reflection, transmission);
        return BsdfNumbers{lobe_number(event.lobe == 0, p, v.place), v.direction};
    }

  private:
    ColorInput reflectance_, transmittance_;
    double reflection_power_, transmission_power_;
};

}  // namespace keyhole
