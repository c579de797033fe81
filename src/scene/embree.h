// Embree behind a small interface. Every difference between Embree 3 and 4 is in this file.
//
// Rays are queried in float. Shapes that are not meshes are user geometry and decide their hits in double precision,
// from the ray that travels with the query.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/lanes.h"
#include "base/phase.h"
#include "scene/instance.h"
#include "scene/shape.h"

namespace keyhole {

class AnalyticShape;
class MeshShape;

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline void init_context(EmbreeContext& context) { rtcInitRayQueryContext(&context); }
inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& query) {
    const PhaseScope phase(Phase::tracing);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &query, &arguments);
}
inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& query) {
    const PhaseScope phase(Phase::tracing);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &query, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
inline void init_context(EmbreeContext& context) { rtcInitIntersectContext(&context); }
inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& query) {
    const PhaseScope phase(Phase::tracing);
    rtcIntersect1(scene, &context, &query);
}
inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& query) {
    const PhaseScope phase(Phase::tracing);
    rtcOccluded1(scene, &context, &query);
}
#endif

// A hierarchy: the whole scene, or a group of shapes that is seen through instances.
class EmbreeGroup {
  public:
    EmbreeGroup(RTCDevice device, bool robust);
    ~EmbreeGroup() { rtcReleaseScene(scene_); }
    EmbreeGroup(const EmbreeGroup&) = delete;
    EmbreeGroup& operator=(const EmbreeGroup&) = delete;

    // Shapes must outlive the group and not move.
    void add(const MeshShape& shape);
    void add(const AnalyticShape& shape);
    void commit() { rtcCommitScene(scene_); }

    RTCScene handle() const { return scene_; }
    const Shape* shape(unsigned id) const { return shapes_[id]; }

  private:
    friend class EmbreeScene;
    unsigned attach(RTCGeometry geometry, const Shape* shape);  // returns the geometry id

    RTCDevice device_;
    RTCScene scene_;
    std::vector<const Shape*> shapes_;  // by geometry id; null for instances
};

struct EmbreeInstance {
    const EmbreeGroup* group;
    const Shape* shape;  // what it shows; null: the group's own shapes
    InstanceTransform transform;
};

struct EmbreeBounds {
    Vec3 lower, upper;  // lower > upper if empty
};

class EmbreeScene {
  public:
    explicit EmbreeScene(bool robust);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    EmbreeGroup& top() { return *top_; }
    EmbreeGroup& new_group();
    // `shape` stands for the group's only shape, with a BSDF of its own, unless it is null.
    void add_instance(const EmbreeGroup& group, const Shape* shape, const Affine& to_world);
    // Builds the groups, then the scene. Throws std::runtime_error if Embree reports an error.
    void commit();

    // Calls visit(shape, to_world) for every shape as it is seen, through instances too, relative to the scene's
    // origin.
    template <class Visit>
    void for_each_shape(const Visit& visit) const {
        for (const Shape* shape : top_->shapes_)
            if (shape) visit(*shape, Affine::Identity());
        for (const auto& instance : instances_) {
            if (!instance) continue;
            for (const Shape* shape : instance->group->shapes_)
                if (shape) visit(*shape, instance->transform.to_world);
        }
    }

    EmbreeBounds bounds() const;
    std::size_t bytes() const { return static_cast<std::size_t>(bytes_.load()); }

    // The nearest surface; null if there is none. Rays are relative to the scene's origin.
    const Shape* intersect(const Ray& ray, ShapeHit& hit) const {
        Context context(*this, ray);
        RTCRayHit r = ray_hit(ray);
        embree_intersect(top_->handle(), context, r);
        if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return nullptr;
        hit.primitive = r.hit.primID;
        hit.t = r.ray.tfar;
        if (r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) [[likely]] {
            hit.instance = nullptr;
            return top_->shape(r.hit.geomID);
        }
        const EmbreeInstance& instance = *instances_[r.hit.instID[0]];
        hit.instance = &instance.transform;
        return instance.shape ? instance.shape : instance.group->shape(r.hit.geomID);
    }

    bool unoccluded(const Ray& ray) const {
        Context context(*this, ray);
        RTCRay r;
        set_ray(ray, r);
        embree_occluded(top_->handle(), context, r);
        return r.tfar >= 0;  // Embree sets it to -inf at a hit
    }

    // What travels with a query to the callbacks of user geometry.
    struct Context : EmbreeContext {
        Context(const EmbreeScene& s, const Ray& r) : scene(s), ray(r) { init_context(*this); }
        const EmbreeScene& scene;
        const Ray& ray;
    };
    const EmbreeInstance& instance(unsigned id) const { return *instances_[id]; }
    RTCScene handle() const { return top_->handle(); }
    static RTCRayHit ray_hit(const Ray& ray) {
        RTCRayHit r;
        set_ray(ray, r.ray);
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        return r;
    }

  private:
    static void store_floats(const Vec3& v, double w, float* out) {
        const Float4 floats = __builtin_convertvector((Double4{v.x(), v.y(), v.z(), w}), Float4);
        std::memcpy(out, &floats, sizeof(floats));
    }
    // Four floats are stored at once, as Embree reads them: a vector load of separate stores would stall.
    static void set_ray(const Ray& ray, RTCRay& r) {
        store_floats(ray.o + ray.offset, ray.tnear, &r.org_x);  // and tnear
        store_floats(ray.d, 0, &r.dir_x);                       // and time
        r.tfar = static_cast<float>(ray.tfar);
        r.mask = ~0u;
        r.id = 0;
        r.flags = 0;
    }

    RTCDevice device_;
    std::atomic<std::int64_t> bytes_{0};
    std::string error_;
    bool robust_;
    std::unique_ptr<EmbreeGroup> top_;
    std::vector<std::unique_ptr<EmbreeGroup>> groups_;
    std::vector<std::unique_ptr<EmbreeInstance>> instances_;  // by geometry id; null for shapes
};

}  // namespace keyhole
