// Every BSDF of the scene reader. One file of bsdfs/ each; parameters and defaults are Mitsuba's.
#pragma once

#include <memory>

#include "scene/bsdf.h"
#include "scene/texture.h"

namespace keyhole {

using BsdfPtr = std::shared_ptr<const Bsdf>;

enum class MicrofacetType { ggx, beckmann };

struct ConductorIor {
    Spectrum eta{0.0, 0.0, 0.0}, k{1.0, 1.0, 1.0};  // relative to the outside; the default is a perfect mirror
};

BsdfPtr make_diffuse(ColorInput reflectance);
BsdfPtr make_conductor(const ConductorIor& ior, ColorInput specular_reflectance);
BsdfPtr make_rough_conductor(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v, const ConductorIor& ior,
                             ColorInput specular_reflectance);
// eta: interior over exterior index of refraction, > 0.
BsdfPtr make_dielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance);
BsdfPtr make_thin_dielectric(double eta, ColorInput specular_reflectance, ColorInput specular_transmittance);
BsdfPtr make_rough_dielectric(MicrofacetType type, ScalarInput alpha_u, ScalarInput alpha_v, double eta,
                              ColorInput specular_reflectance, ColorInput specular_transmittance);
// Smooth or rough dielectric coat over a diffuse base; `nonlinear` accounts for colour shifts by internal scattering.
BsdfPtr make_plastic(double eta, ColorInput diffuse_reflectance, ColorInput specular_reflectance, bool nonlinear);
BsdfPtr make_rough_plastic(MicrofacetType type, double alpha, double eta, ColorInput diffuse_reflectance,
                           ColorInput specular_reflectance, bool nonlinear);
BsdfPtr make_phong(ScalarInput exponent, ColorInput diffuse_reflectance, ColorInput specular_reflectance);
BsdfPtr make_mask(BsdfPtr nested, ScalarInput opacity);
BsdfPtr make_two_sided(BsdfPtr front, BsdfPtr back);  // back may be the same as front
BsdfPtr make_bump_map(BsdfPtr nested, std::shared_ptr<const Texture> displacement, double scale);
BsdfPtr make_null();
BsdfPtr make_blend(BsdfPtr first, BsdfPtr second, ScalarInput weight);  // weight 1 is all `second`

}  // namespace keyhole
