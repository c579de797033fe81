// States of one path by one technique.
#pragma once

#include "inverse/inverse.h"
#include "strategies/evaluator.h"

namespace keyhole {

// What a mix's strategies ask of states beside their coordinates.
struct StateNeeds {
    bool path = false;     // the vertices stay with the state
    bool forgets = false;  // some move leaves the state's coordinates unknown
    bool measure = false;  // of the path, for moves in path space
};

class ChartEvaluator final : public Evaluator {
  public:
    ChartEvaluator(const Scene& scene, const CoordinateLayout& layout, const ChartTarget& target = {},
                   StateNeeds needs = {});

    PssState make_state() const override;
    PathFailure evaluate(PssState& y) override;
    bool find_technique(PssState& x, Rng& rng) override;
    bool find_coordinates(PssState& x, Rng& rng) override;
    bool may_move_in_chart(PssState& x, Rng& rng) override;

    const CoordinateLayout& layout() const override { return chart_.layout(); }
    const RasterWindow& window() const override { return chart_.window(); }
    Tracer& tracer() override { return chart_.tracer(); }
    Chart& chart() { return chart_; }

    // Of states that keep their paths:

    // w_t(x) of all techniques, at t - 1. Valid until the next call.
    std::span<const double> weights(const PssState& x);
    // Coordinates of x's path by technique t.
    bool invert(const PssState& x, int t, PrimarySample& u, Rng& rng);
    // y becomes x's path by technique t, traced again. False where there is no inverse or it does not lead back to the
    // path, and where there is none by x's own technique (known), by which the way back would go.
    bool go_over(PssState& x, int t, PssState& y, Rng& rng);

    // Of states that measure their paths:

    // Null where rounding denies a path that a chart has made (at the film's border): no move in path space may start
    // or end there.
    const PathMeasure* measure(const PssState& x);
    // Completes a state of which only the path's vertices and k are set: what it contributes, without its visibility,
    // and C by all techniques; its technique is not known. After a failure its target is 0.
    PathFailure complete(PssState& y);

  private:
    Chart chart_;
    StateNeeds needs_;
    std::vector<double> weights_;
    PrimarySample unread_;
    SampledPath again_;  // room to trace a path for a second time
};

}  // namespace keyhole
