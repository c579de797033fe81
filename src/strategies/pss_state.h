// The state of a chain: a path, what it contributes, and the coordinates by which one technique makes it, as far as
// they are known.
#pragma once

#include <vector>

#include "pathspace/measure.h"
#include "pss/chart.h"

namespace keyhole {

// What a state knows of its chart. Moves in path space leave the path alone; the rest is drawn when a move in primary
// sample space asks for it: the technique from its conditional w_t(x), the coordinates by the inverse.
enum class Known : std::uint8_t { path, technique, coordinates };

// A path's contribution f / f* and where it goes.
struct Splat {
    Spectrum value{0, 0, 0};
    Vec2 raster{0, 0};
};

struct PssState {
    PrimarySample u;          // k always holds; t and the coordinates as far as known
    double target = 0;        // C(x) = w_t f* / p_t, the chain's target in chart coordinates
    Spectrum splat{0, 0, 0};  // f / f*
    Vec2 raster{0, 0};
    Known known = Known::coordinates;
    bool inverse_exists = false;  // found so for this path and technique; false: not tried
    SampledPath path;             // without room unless a strategy of the mix asks for paths
    // Cached for moves in path space; without room unless a strategy of the mix asks for it.
    mutable PathMeasure measure;
    mutable bool measured = false;
    std::vector<Splat> more;  // with all connections at once: the splats beside the first

    explicit PssState(const CoordinateLayout& layout) : u(layout) {}

    bool keeps_path() const { return !path.room.empty(); }

    // Takes over what a chart found at u.
    void set(const Evaluation& e) {
        raster = e.raster;
        target = e.target;
        known = Known::coordinates;
        inverse_exists = measured = false;
        if (target > 0) splat = e.contribution / target;
    }
};

}  // namespace keyhole
