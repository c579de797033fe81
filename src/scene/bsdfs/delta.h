// Base of the BSDFs that have delta lobes only: nothing to evaluate.
#pragma once

#include "scene/bsdf.h"

namespace keyhole {

class DeltaBsdf : public Bsdf {
  public:
    DeltaBsdf() { traits_.delta = true; }

    BsdfValue eval(const SurfacePoint&, const Vec3&, const Vec3&) const final { return {Spectrum::Zero(), 0, 0}; }

  protected:
    // A sample of a lobe that both ends choose with the same probability.
    static BsdfSample delta_sample(const Vec3& w, const Spectrum& weight, double probability, double eta = 1,
                                   std::uint8_t lobe = 0) {
        return {w, weight, probability, probability, eta, lobe, true};
    }
};

}  // namespace keyhole
