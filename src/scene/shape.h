// Shapes: what rays hit. Meshes keep float positions as Embree does; hits are intersected again in double precision, so
// that a hit point lies on its surface and on its ray to double precision.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "scene/bsdfs.h"
#include "scene/emitter.h"
#include "scene/surface.h"

namespace keyhole {

struct Ray {
    Vec3 o, d;  // d is unit length
    double tnear = 0, tfar = std::numeric_limits<double>::infinity();
};

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  // empty: face normals
    std::vector<Vec2f> uvs;      // empty: none; uv are then the barycentric coordinates
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t bytes() const;
};

// A point drawn on a shape, uniform in area.
struct ShapeSample {
    Vec3 p, ng;
    Vec2 uv;
};

class Shape {
  public:
    virtual ~Shape() = default;

    // Where the ray meets primitive `primitive`: the exact parametric distance and the surface there (all fields but
    // bsdf and emitter). `ray` need not hit it exactly (Embree decided in float); the point is on the surface's plane.
    virtual double fill(const Ray& ray, std::uint32_t primitive, SurfacePoint& x) const = 0;

    virtual double area() const = 0;
    virtual ShapeSample sample(double u_primitive, const Vec2& u) const = 0;  // pdf 1 / area()

    std::string id;        // of the scene file, may be empty
    BsdfPtr bsdf;
    std::shared_ptr<Emitter> emitter;  // area emitter or null
    bool flip_normals = false;
};

}  // namespace keyhole
