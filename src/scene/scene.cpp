#include "scene/scene.h"

#include <algorithm>

#include "scene/embree.h"
#include "scene/shapes/mesh_shape.h"

namespace keyhole {

Scene::Scene() = default;
Scene::~Scene() = default;

bool Scene::intersect_shapes(const Ray& ray, SurfacePoint& x) const {
    ShapeHit hit;
    const Shape* shape = embree_->intersect({ray.o + ray.offset, ray.d, ray.tnear, ray.tfar}, hit);
    if (!shape) return false;
    shape->fill(ray, hit, x);
    x.bsdf = shape->bsdf.get();
    x.emitter = shape->emitter.get();
    return true;
}

bool Scene::intersect(const Ray& ray, SurfacePoint& x) const {
    if (!moved_) [[likely]]
        return intersect_shapes(ray, x);
    Ray moved = ray;
    moved.o -= origin_;
    if (!intersect_shapes(moved, x)) return false;
    x.p += origin_;
    x.offset += origin_rounding(origin_);
    return true;
}

bool Scene::unoccluded(const Ray& ray) const {
    return embree_->unoccluded({ray.o + ray.offset - origin_, ray.d, ray.tnear, ray.tfar});
}

std::uint32_t Scene::choose_emitter(double u) const {
    if (emitters_.size() == 1) return 0;
    const auto found = std::upper_bound(emitter_cdf_.begin(), emitter_cdf_.end(), u);
    return static_cast<std::uint32_t>(found - emitter_cdf_.begin());
}

}  // namespace keyhole
