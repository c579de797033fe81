// States of all techniques at once [Kelemen et al. 2002]: the coordinates of an eye and a light subpath, as long as
// they get, and all paths that connecting them makes. The target is the sum of what those contribute.
#pragma once

#include "pathspace/all_connections.h"
#include "strategies/evaluator.h"

namespace keyhole {

// The technique of such states: the layout's count(0, 0) coordinates belong to it.
class BundleEvaluator final : public Evaluator {
  public:
    BundleEvaluator(const Scene& scene, const CoordinateLayout& layout, LengthRange lengths, const ChartTarget& target);

    PssState make_state() const override;
    PathFailure evaluate(PssState& y) override;

    const CoordinateLayout& layout() const override { return *layout_; }
    const RasterWindow& window() const override { return connections_.window(); }
    Tracer& tracer() override { return connections_.tracer(); }

  private:
    const CoordinateLayout* layout_;
    TargetFunction target_;
    AllConnections connections_;
};

}  // namespace keyhole
