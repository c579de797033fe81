// Share of light that enters a medium through a rough dielectric boundary, whatever its direction inside.
#pragma once

#include <array>
#include <memory>

#include "scene/bsdfs.h"

namespace keyhole {

class RoughTransmittance {
  public:
    // eta: index of refraction of the inside over the outside. A few milliseconds.
    RoughTransmittance(MicrofacetType type, double alpha, double eta);

    // T(cos): transmitted share of a beam from outside at `cos_theta` in [0, 1], single scattering; error about 1e-4.
    double operator()(double cos_theta) const;

    // Share of diffuse light inside that does not get out. By reciprocity what gets out is
    // 2 / eta^2 times the integral of cos T(cos) dcos.
    double internal_diffuse_reflectance() const { return internal_reflectance_; }

  private:
    static constexpr int intervals = 64;
    // At cos = (i / intervals)^2, with one extrapolated value before the first and after the last.
    std::array<double, intervals + 3> values_{};
    double internal_reflectance_ = 0;
};

// The table of these parameters; made once for all that ask for it while it is in use.
std::shared_ptr<const RoughTransmittance> rough_transmittance(MicrofacetType type, double alpha, double eta);

}  // namespace keyhole
