#include "scene/instance.h"

namespace keyhole {
namespace {

// Not to be inlined: g++ 12 then computes the inverse of the transform from before the rounding (-O2, seen on vectors).
[[gnu::noinline]] Affine rounded_to_float(const Affine& transform) { return transform.cast<float>().cast<double>(); }

}  // namespace

InstanceTransform::InstanceTransform(const Affine& transform)
    : to_world(rounded_to_float(transform)),
      to_local(to_world.inverse()),
      normal(to_local.linear().transpose()),
      magnitude(to_local.linear().cwiseAbs() * to_world.linear().cwiseAbs() * to_local.linear().cwiseAbs()) {}

}  // namespace keyhole
