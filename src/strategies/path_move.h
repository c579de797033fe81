// What moves in path space have in common. They see a state as the vertices of its path; a proposal that is accepted
// leaves the technique and the coordinates to be drawn by whoever asks for them (theory, section 4). With T(x -> y) the
// density of the proposal's changed vertices, in the area measure,
//     r = [f*(y) / T(x -> y)] / [f*(x) / T(y -> x)].
// All densities are logarithms: no product over a long path leaves the range of double.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {

class PathMove : public PssStrategy {
  protected:
    explicit PathMove(ChartEvaluator& charts) : charts_(charts) {}

    const Scene& scene() const { return charts_.tracer().scene(); }
    const RasterWindow& window() const { return charts_.window(); }
    Tracer& tracer() const { return charts_.tracer(); }

    static const Vertex& at(const PssState& x, int i) { return x.path.room[static_cast<std::size_t>(i)]; }
    // y becomes the vertices of x, of which some are then made anew.
    static void keep(const PssState& x, PssState& y) {
        y.path.k = x.path.k;
        std::copy_n(x.path.room.data(), x.path.k + 1, y.path.room.data());
    }

    // The proposal from the ln T of both ways; `y` is complete. Fails where the way back is impossible.
    static Proposal proposal(const PssState& x, const PssState& y, double log_forth, double log_back) {
        if (log_back == -std::numeric_limits<double>::infinity()) return Proposal::failed(Failure::outside_support);
        return {std::exp(y.measure.log_f - log_forth - (x.measure.log_f - log_back)), Failure::none};
    }

    ChartEvaluator& charts_;
};

}  // namespace keyhole
