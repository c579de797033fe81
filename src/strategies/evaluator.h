// Fills states in: what they contribute from their coordinates, and what they do not know of their chart yet.
#pragma once

#include "base/rng.h"
#include "strategies/pss_state.h"

namespace keyhole {

// One for each thread.
class Evaluator {
  public:
    virtual ~Evaluator() = default;

    // A state with room for what the mix needs, and of no meaning.
    virtual PssState make_state() const = 0;

    // Sets y from its coordinates. After a failure its target is 0.
    virtual PathFailure evaluate(PssState& y) = 0;

    // Draw what x does not know yet: the technique from its conditional, the coordinates by its inverse. False where
    // there is no inverse, or it does not lead back to the path.
    virtual bool find_technique(PssState&, Rng&) { return true; }
    virtual bool find_coordinates(PssState&, Rng&) { return true; }

    // Whether a move in the chart of x (known) may start or end there. A state that forgets its coordinates needs an
    // inverse to move on; so where states do, moves to and from paths without one are refused alike.
    virtual bool may_move_in_chart(PssState&, Rng&) { return true; }

    virtual const CoordinateLayout& layout() const = 0;
    virtual const RasterWindow& window() const = 0;
    virtual Tracer& tracer() = 0;
};

}  // namespace keyhole
