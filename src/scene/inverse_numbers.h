// What inverses of samplers need beside the sample.
#pragma once

#include <cmath>

#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {

// Fresh uniform numbers of [0, 1) for an inverse that is not unique. Numbers that a sampler does not read come out of
// its inverse as they stand here, so that they are uniform and independent of the sample.
struct InverseNumbers {
    double branch = 0;     // which of the lobes that can draw a direction did
    double place = 0;      // where in its interval a number lies that made a discrete choice
    Vec2 direction{0, 0};  // in place of continuous numbers that are not read
};

inline InverseNumbers fresh_numbers(Rng& rng) {
    InverseNumbers v;
    v.branch = rng.uniform();
    v.place = rng.uniform();
    v.direction.x() = rng.uniform();
    v.direction.y() = rng.uniform();
    return v;
}

// The number of [begin, end) at a position of [0, 1); the interval is not empty.
inline double number_in_interval(double position, double begin, double end) {
    const double u = begin + position * (end - begin);
    return u < end ? u : std::nextafter(end, begin);
}

}  // namespace keyhole
