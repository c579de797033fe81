// A worker's view of the scene: casts rays and counts them. With a recorder it also keeps them, in order, so that they
// can be replayed through Embree alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/replay.h"
#include "scene/scene.h"

namespace keyhole {

class Tracer {
  public:
    explicit Tracer(const Scene& scene) : scene_(&scene) {}

    const Scene& scene() const { return *scene_; }

    bool intersect(const Ray& ray, SurfacePoint& hit, Wanted wanted = Wanted::surface) {
        note(ray, false);
        return scene_->intersect(ray, hit, wanted);
    }
    bool unoccluded(const Ray& ray) {
        note(ray, true);
        return scene_->unoccluded(ray);
    }
    // The open segment between two points, each offset from its surface; see `segment`.
    bool visible(const Vec3& a, const Vec3& b, double inverse_length) {
        return unoccluded(segment(a, b, inverse_length));
    }

    std::uint64_t rays() const { return rays_; }
    void record_into(std::vector<RecordedRay>* rays) { recorder_ = rays; }

  private:
    void note(const Ray& ray, bool occlusion) {
        ++rays_;
        if (recorder_) recorder_->push_back({ray, occlusion});
    }

    const Scene* scene_;
    std::uint64_t rays_ = 0;
    std::vector<RecordedRay>* recorder_ = nullptr;
};

}  // namespace keyhole
