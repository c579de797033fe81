// A point on a surface, as all of transport sees it.
#pragma once

#include <cstdint>

#include "base/frame.h"
#include "base/vec.h"

namespace keyhole {

class Bsdf;
class Emitter;

struct SurfacePoint {
    Vec3 p;         // world position, on the surface to double precision
    Vec3 ng;        // unit geometric normal, on the same side as frame.n
    Frame frame;    // shading frame, frame.n the shading normal; frame.s along dp/du where `bsdf` needs tangents
    Vec2 uv{0, 0};  // filled only where `bsdf` or the emitter needs it
    // dp/du = du_s * s and dp/dv = dv_s * s + dv_t * t, projected into the shading frame's tangent plane.
    // Filled only where `bsdf` needs tangents.
    float du_s = 1, dv_s = 0, dv_t = 1;
    // Bounds of a ray query's float error at p, as a distance along ng: of a ray that starts there, and what is to be
    // added for one that ends there, per length.
    float offset = 0, offset_per_length = 0;
    std::uint32_t primitive = 0;  // of the shape: a triangle
    const Bsdf* bsdf = nullptr;
    const Emitter* emitter = nullptr;  // area emitter of the shape, if any
};

}  // namespace keyhole
