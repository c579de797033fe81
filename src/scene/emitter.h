// Emitters. The light end of a path is an endpoint: a point on a surface or in space, or, for emitters at infinity,
// a direction. A light subpath draws the endpoint first and then the ray that leaves it; next-event estimation draws
// the endpoint only. Both use the same density of the endpoint, so that the density of a path factorises by vertex.
#pragma once

#include <cstdint>
#include <optional>

#include "base/spectrum.h"
#include "base/vec.h"
#include "scene/inverse_numbers.h"

namespace keyhole {

struct EmitterPoint {
    Vec3 p;   // position; at infinity: unit direction from the scene towards the emitter
    Vec3 ng;  // unit normal of an area emitter's surface, else zero
    Vec2 uv{0, 0};
    double pdf = 0;  // density given the emitter: area; at infinity: solid angle; 1 where `delta`
    float offset = 0, offset_per_length = 0;  // area emitters: as SurfacePoint's
    std::uint32_t primitive = 0;              // area emitters: of the shape
};

// The numbers that Emitter::sample_point reads.
struct EmitterNumbers {
    double part = 0;
    Vec2 point{0, 0};
};

struct EmissionRay {
    Vec3 o, d;   // d is unit length and leaves the emitter
    double pdf;  // of d given the endpoint, solid angle; at infinity: of o, area on the plane perpendicular to d
};

struct EmitterTraits {
    bool infinite = false;     // endpoints are directions
    bool delta = false;        // the endpoint's position (or, at infinity, direction) is fixed
    bool surface = false;      // rays can hit it: area emitters
    bool environment = false;  // rays that escape see it: constant and envmap
};

class Emitter {
  public:
    virtual ~Emitter() = default;

    // `u_part` chooses among discrete parts (a triangle, a texel row) and nothing else. All in [0,1).
    virtual EmitterPoint sample_point(double u_part, const Vec2& u) const = 0;
    // Density of that endpoint, in the measure of EmitterPoint::pdf; 0 for delta emitters.
    virtual double pdf_point(const EmitterPoint& e) const = 0;

    // Its inverse: numbers that draw the endpoint. Empty where none do.
    virtual std::optional<EmitterNumbers> invert_point(const EmitterPoint& e, const InverseNumbers& v) const = 0;

    // The ray that leaves the endpoint.
    virtual EmissionRay sample_ray(const EmitterPoint& e, const Vec2& u) const = 0;
    // Its inverse: numbers that draw the ray which meets `x`. Empty where none do.
    virtual std::optional<Vec2> invert_ray(const EmitterPoint& e, const Vec3& x) const = 0;
    // Its density in the measure of EmissionRay::pdf. `w` is a unit direction leaving the emitter.
    virtual double pdf_ray(const EmitterPoint& e, const Vec3& w) const = 0;

    // What leaves the endpoint along unit `w`, times the cosine at an area emitter's surface: radiance * cos (area),
    // intensity (point, spot), radiance (environment), irradiance on a perpendicular plane (directional).
    virtual Spectrum emitted(const EmitterPoint& e, const Vec3& w) const = 0;

    // Radiance towards unit `w` from a surface point or, at infinity, along -e.p. Zero behind an area emitter.
    virtual Spectrum radiance(const EmitterPoint& e, const Vec3& w) const = 0;

    // Emitted power, RGB, for choosing among emitters. Emitters at infinity use the scene's bounding sphere.
    virtual Spectrum power() const = 0;

    // Bounding sphere of the scene; called once before any sampling.
    virtual void set_scene_bounds(const Vec3& /*center*/, double /*radius*/) {}

    virtual const char* name() const = 0;
    const EmitterTraits& traits() const { return traits_; }

    // Index in Scene::emitters() and the probability that Scene::choose_emitter chooses it; set by the scene.
    std::uint32_t index() const { return index_; }
    double selection_probability() const { return selection_probability_; }

  protected:
    EmitterTraits traits_;

  private:
    friend class SceneBuilder;
    std::uint32_t index_ = 0;
    double selection_probability_ = 0;
};

}  // namespace keyhole
