// The most common of all materials, a diffuse BSDF seen from both sides, as one BSDF.
#pragma once

#include "scene/bsdfs.h"

namespace keyhole {

// What make_two_sided makes of a diffuse BSDF for both sides; null if `bsdf` is another one.
BsdfPtr diffuse_on_both_sides(const Bsdf& bsdf);

}  // namespace keyhole
