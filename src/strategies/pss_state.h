// The state of a chain that moves in primary sample space only.
#pragma once

#include "pss/chart.h"

namespace keyhole {

struct PssState {
    PrimarySample u;
    double target = 0;        // C(x) = w_t f* / p_t, the chain's target in chart coordinates
    Spectrum splat{0, 0, 0};  // f / f*
    Vec2 raster{0, 0};

    explicit PssState(const CoordinateLayout& layout) : u(layout) {}

    // Takes over what a chart found at u.
    void set(const Evaluation& e) {
        raster = e.raster;
        target = e.target;
        if (target > 0) splat = e.contribution / target;
    }
};

}  // namespace keyhole
