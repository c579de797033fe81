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
    // The query starts at o + offset, so that a ray does not hit the surface it leaves; the hit point is on o + t d.
    Vec3 offset{0, 0, 0};
};

// The open segment from a to b, which differ. Ends on surfaces must be offset (Scene).
// `inverse_length` is about the inverse of their distance; the ray's direction is as close to unit length as that.
inline Ray segment(const Vec3& a, const Vec3& b, double inverse_length) {
    return {a, (b - a) * inverse_length, 0, 1 / inverse_length};
}
inline Ray segment(const Vec3& a, const Vec3& b) { return segment(a, b, 1 / (b - a).norm()); }

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
    float offset = 0, offset_per_length = 0;  // as SurfacePoint's
    std::uint32_t primitive = 0;
};

struct InstanceTransform;  // instance.h

// What a float query found, to be refined by the shape.
struct ShapeHit {
    std::uint32_t primitive = 0;
    float t = 0;                                  // along the ray; good to a few float digits
    const InstanceTransform* instance = nullptr;  // of the instance the shape was seen through, if any
};

// What adding an origin to coordinates relative to it, and subtracting it again, may move a point by.
inline float origin_rounding(const Vec3& origin) { return static_cast<float>(0x1p-51 * origin.lpNorm<1>()); }

class Shape {
  public:
    explicit Shape(bool mesh = false) : is_mesh(mesh) {}
    virtual ~Shape() = default;

    // Where the ray meets the surface, in double precision: the distance (returned) and the surface there (all fields
    // but bsdf and emitter). The ray may miss by a float error; the point is on the plane of the hit triangle, or on
    // the surface of any other shape.
    virtual double fill(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const = 0;

    virtual double area() const = 0;
    virtual ShapeSample sample(double u_primitive, const Vec2& u) const = 0;  // pdf 1 / area()

    // The inverse of sample(): numbers that draw the point p of a primitive.
    virtual EmitterNumbers invert_sample(std::uint32_t primitive, const Vec3& p, const InverseNumbers& v) const = 0;

    const bool is_mesh;    // is a MeshShape
    Vec3 origin{0, 0, 0};  // of the scene: fill and sample work in coordinates relative to it
    std::string id;        // of the scene file, may be empty
    BsdfPtr bsdf;
    std::shared_ptr<Emitter> emitter;  // area emitter or null
    bool flip_normals = false;
    bool needs_uv = true, needs_tangents = false;  // what fill and sample must write
};

}  // namespace keyhole
