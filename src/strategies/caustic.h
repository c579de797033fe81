// The caustic perturbation [Veach and Guibas 1997, 5.3.3]: traces a path again from its light's side.
#pragma once

#include "strategies/perturbation.h"

namespace keyhole {

// For paths x_0 x_1 x_2 .. x_j of which x_1 and x_j are rough (x_j may be the emitter's point as well) and all between
// are specular, at least one. The direction from x_j is perturbed, the chain followed, and y_1 connected to the sensor.
// Not for emitters at infinity as x_j. Refused where y has another chain than x.
class CausticPerturbation final : public Perturbation {
  public:
    // Steps of a size for all edges; or, without one, of sizes in pixels: the angle by which a step of so many pixels
    // turns the direction, were all between x_j and x_1 flat: pixel size at x_1 over the length of the chain.
    CausticPerturbation(ChartEvaluator& charts, std::unique_ptr<const StepSize> size, const RasterStep& raster,
                        double roughness);
    std::string_view name() const override { return size_->from_geometry() ? "caustic-geo" : "caustic"; }
    double suitability(const PssState& x) const override { return start(x) > 0 ? 1 : 0; }
    bool suitability_varies() const override { return true; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    // j; 0 if it does not apply.
    int start(const PssState& x) const;
    Failure retrace(const PssState& x, PssState& y, int start, Rng& rng) const;
    DirectionKernel kernel(const PssState& x, int start) const;

    std::unique_ptr<const StepSize> size_;
    RasterStep raster_;
};

}  // namespace keyhole
