// The lens and the multi-chain perturbation: both trace a path again from the sensor.
#pragma once

#include "strategies/perturbation.h"

namespace keyhole {

// From the sensor the path goes through vertices that are all specular up to x_a, the first that is not: chain 1. Where
// x_{a+1} is one again, its direction is perturbed as well and another chain follows, up to x_b, which is rough and
// followed by a rough vertex or by the emitter; x_b is connected to that one. A path whose last chain reaches the
// emitter has b = k and is not connected. Paths of one chain are the lens perturbation's, those of more the
// multi-chain perturbation's. Refused where y has other chains than x.
class EyePerturbation : public Perturbation {
  public:
    enum class Chains { one, many };
    EyePerturbation(ChartEvaluator& charts, Chains chains, std::unique_ptr<const StepSize> size, double roughness,
                    const RasterStep& raster);
    std::string_view name() const override {
        if (chains_ == Chains::one) return size_->from_geometry() ? "lens-geo" : "lens";
        return size_->from_geometry() ? "multichain-geo" : "multichain";
    }
    double suitability(const PssState& x) const override;
    bool suitability_varies() const override { return true; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  protected:
    struct Structure {
        int chains = 0, end = 0;  // b
        bool operator==(const Structure&) const = default;
    };
    Structure structure(const PssState& x) const;
    // y_1 .. y_b, from the sensor; then whether y, complete, has the chains of x; and the ln T of these vertices.
    Failure walk(const PssState& x, PssState& y, int end, Rng& rng) const;
    bool same_structure(const PssState& x, const PssState& y, const Structure& of_x) const;
    Densities walked(const PssState& x, const PssState& y, int end) const;

  private:
    Failure perturb_primary(const PssState& x, PssState& y, Rng& rng) const;
    std::optional<Vec2> primary_raster(const PssState& x, Rng& rng) const;

    DirectionKernel kernel(const PssState& x, int i) const;

    Chains chains_;
    std::unique_ptr<const StepSize> size_;
    RasterStep raster_;
};

}  // namespace keyhole
