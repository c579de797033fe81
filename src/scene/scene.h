// The scene as transport sees it: rays, emitters, a sensor and the film's settings.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/bsdf.h"
#include "scene/emitter.h"
#include "scene/filter.h"
#include "scene/portals.h"
#include "scene/sensor.h"
#include "scene/shape.h"

namespace keyhole {

class BoxHierarchy;  // box_hierarchy.h
class EmbreeScene;   // embree.h

// What is to be known of a hit. `emitter`: of a surface that emits nothing, nothing but that.
enum class Wanted { surface, emitter };

// What a scene needs from the algorithms; nothing else is paid for.
struct Requirements {
    BsdfTraits bsdfs;          // the union over all BSDFs in use
    bool aperture = false;     // lens coordinates
    bool environment = false;  // rays that escape carry light
    bool infinite_emitters = false;
    bool delta_emitters = false;
};

struct SceneStatistics {
    std::size_t triangles = 0;  // as traced, instances multiplied
    std::size_t unique_triangles = 0;
    std::size_t shapes = 0, instances = 0, emitters = 0, bsdfs = 0, textures = 0;
    std::size_t mesh_bytes = 0, texture_bytes = 0, embree_bytes = 0;
};

class Scene {
  public:
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene();

    // The nearest surface along the ray within (tnear, tfar); the second form fills `x` in place if there is one.
    std::optional<SurfacePoint> intersect(const Ray& ray) const {
        std::optional<SurfacePoint> x(std::in_place);
        if (!intersect(ray, *x)) x.reset();
        return x;
    }
    bool intersect(const Ray& ray, SurfacePoint& x, Wanted wanted = Wanted::surface) const;
    // Whether the ray is free of surfaces within (tnear, tfar).
    bool unoccluded(const Ray& ray) const;

    // Rays that leave a surface start, and segments that reach one end, off it by an error bound that scales with the
    // coordinates. `w` points to the side the ray is on. Points that are on no surface stay where they are.
    static Vec3 offset_origin(const SurfacePoint& x, const Vec3& w) { return x.p + side(x.ng, w) * x.offset * x.ng; }
    static Vec3 offset_origin(const EmitterPoint& e, const Vec3& w) { return e.p + side(e.ng, w) * e.offset * e.ng; }
    // Where a ray of the given length that arrives from the direction `w` ends: before x by its own error.
    static Vec3 offset_target(const SurfacePoint& x, const Vec3& w, double length) {
        return x.p + side(x.ng, w) * (x.offset + x.offset_per_length * length) * x.ng;
    }
    // The ray that leaves a surface along the unit direction `w`: tested from off it, with the exact origin for the
    // hit.
    static Ray ray_from(const SurfacePoint& x, const Vec3& w) {
        return {x.p, w, 0, std::numeric_limits<double>::infinity(), side(x.ng, w) * x.offset * x.ng};
    }
    static Ray ray_from(const EmitterPoint& e, const Vec3& w) {
        return {e.p, w, 0, std::numeric_limits<double>::infinity(), side(e.ng, w) * e.offset * e.ng};
    }

    // Emitters, chosen by power.
    std::span<const Emitter* const> emitters() const { return emitters_; }
    // Index of the chosen emitter for u in [0,1).
    std::uint32_t choose_emitter(double u) const;
    // Its inverse: a number by which the emitter is chosen, at `place` in its interval.
    double invert_choice(const Emitter& emitter, double place) const;
    double emitter_probability(const Emitter* emitter) const { return emitter->selection_probability(); }
    const Emitter* environment() const { return environment_; }

    const Portals& portals() const { return portals_; }

    // Built when it is first asked for.
    const BoxHierarchy& boxes() const;

    const EmbreeScene& embree() const { return *embree_; }
    // Shapes and Embree's hierarchy have coordinates relative to this point: zero, but for scenes far from it, where
    // floats are coarse.
    const Vec3& origin() const { return origin_; }
    const Sensor& sensor() const { return *sensor_; }
    const FilmSettings& film() const { return film_; }
    const Requirements& requirements() const { return requirements_; }
    const SceneStatistics& statistics() const { return statistics_; }
    Vec3 center() const { return center_; }
    double radius() const { return radius_; }
    // Most edges of a path that the scene file asks for (its integrator's max_depth); 0 if it does not say, -1 if any.
    int max_path_length() const { return max_path_length_; }
    std::uint64_t content_hash() const { return content_hash_; }

  private:
    friend class SceneBuilder;
    Scene();
    bool intersect_shapes(const Ray& ray, SurfacePoint& x, Wanted wanted) const;  // both relative to origin()
    static double side(const Vec3& ng, const Vec3& w) { return w.dot(ng) > 0 ? 1 : -1; }

    Vec3 origin_{0, 0, 0};
    bool moved_ = false;  // origin_ is not zero
    std::vector<std::unique_ptr<const Shape>> shapes_;
    std::unique_ptr<EmbreeScene> embree_;
    mutable std::once_flag boxes_flag_;
    mutable std::unique_ptr<const BoxHierarchy> boxes_;
    std::vector<std::shared_ptr<const Emitter>> owned_emitters_;
    std::vector<const Emitter*> emitters_;
    std::vector<double> emitter_cdf_;  // entry i: probability of emitters 0 to i
    const Emitter* environment_ = nullptr;
    Portals portals_;
    std::unique_ptr<Sensor> sensor_;
    FilmSettings film_;
    Requirements requirements_;
    SceneStatistics statistics_;
    Vec3 center_{0, 0, 0};
    double radius_ = 0;
    int max_path_length_ = 0;
    std::uint64_t content_hash_ = 0;
};

}  // namespace keyhole
