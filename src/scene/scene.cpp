#include "scene/scene.h"

#include <algorithm>

#include "scene/box_hierarchy.h"
#include "scene/embree.h"
#include "scene/shapes/mesh_shape.h"

namespace keyhole {

Scene::Scene() = default;
Scene::~Scene() = default;

inline bool Scene::intersect_shapes(const Ray& ray, SurfacePoint& x, Wanted wanted) const {
    ShapeHit hit;
    const Shape* shape = embree_->intersect(ray, hit);
    if (!shape) return false;
    x.bsdf = shape->bsdf.get();
    x.emitter = shape->emitter.get();
    if (wanted == Wanted::emitter && !x.emitter) return true;
    if (shape->is_mesh) [[likely]]
        static_cast<const MeshShape*>(shape)->fill(ray, hit, x);
    else
        shape->fill(ray, hit, x);
    return true;
}

bool Scene::intersect(const Ray& ray, SurfacePoint& x, Wanted wanted) const {
    if (!moved_) [[likely]]
        return intersect_shapes(ray, x, wanted);
    Ray moved = ray;
    moved.o -= origin_;
    if (!intersect_shapes(moved, x, wanted)) return false;
    x.p += origin_;
    x.offset += origin_rounding(origin_);
    return true;
}

bool Scene::unoccluded(const Ray& ray) const {
    if (!moved_) [[likely]]
        return embree_->unoccluded(ray);
    Ray moved = ray;
    moved.o -= origin_;
    return embree_->unoccluded(moved);
}

const BoxHierarchy& Scene::boxes() const {
    std::call_once(boxes_flag_, [this] { boxes_ = std::make_unique<const BoxHierarchy>(*embree_, origin_); });
    return *boxes_;
}

std::uint32_t Scene::choose_emitter(double u) const {
    if (emitters_.size() == 1) return 0;
    const auto found = std::upper_bound(emitter_cdf_.begin(), emitter_cdf_.end(), u);
    return static_cast<std::uint32_t>(found - emitter_cdf_.begin());
}

double Scene::invert_choice(const Emitter& emitter, double place) const {
    const std::uint32_t i = emitter.index();
    return number_in_interval(place, i > 0 ? emitter_cdf_[i - 1] : 0, emitter_cdf_[i]);
}

}  // namespace keyhole
