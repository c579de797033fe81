// Choosing between lobes with one number.
#pragma once

#include <cstdint>
#include <stdexcept>

#include "base/vec.h"
#include "scene/bsdf.h"

namespace keyhole {

// A number of [0, 1) chooses the interval [begin, end) that it falls in, and its position inside the interval serves as
// the number of the choice that follows. Given the first choice the position is again uniform on [0, 1) and says
// nothing about it, so a sequence of choices splits [0, 1) into one interval per final lobe, and an inverse draws the
// number uniformly in that interval (number_in_interval).
inline double position_in_interval(double u, double begin, double end) { return clamp01((u - begin) / (end - begin)); }

// The number by which the first of two lobes, of probability p, or the second is chosen.
inline double lobe_number(bool first, double p, double position) {
    return first ? number_in_interval(position, 0, p) : number_in_interval(position, p, 1);
}

// Probability of the first of two lobes of powers a and b >= 0 in proportion to them; NaN if both are 0.
inline double share(double a, double b) { return a / (a + b); }

// Traits of a BSDF that may scatter as `a` or as `b`, except the number of lobes.
inline BsdfTraits joined(const BsdfTraits& a, const BsdfTraits& b) {
    BsdfTraits t;
    t.smooth = a.smooth || b.smooth;
    t.delta = a.delta || b.delta;
    t.transmissive = a.transmissive || b.transmissive;
    t.chooses_lobe = a.chooses_lobe || b.chooses_lobe;
    t.needs_uv = a.needs_uv || b.needs_uv;
    t.needs_tangents = a.needs_tangents || b.needs_tangents;
    return t;
}

// Number of lobes where those of one BSDF follow those of another. Throws std::invalid_argument beyond 255.
inline std::uint8_t add_lobes(int first, int second) {
    if (first + second > 255) throw std::invalid_argument("more than 255 lobes in one BSDF");
    return static_cast<std::uint8_t>(first + second);
}

}  // namespace keyhole
