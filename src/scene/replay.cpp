#include "scene/replay.h"

#include <vector>

#include "scene/embree.h"

namespace keyhole {

struct RayReplay::Queries {
    struct Query {
        RTCRayHit embree;
        Ray exact;  // for user geometry
        bool occlusion;
    };
    const EmbreeScene& scene;
    std::vector<Query> rays;
};

RayReplay::RayReplay(const Scene& scene, std::span<const RecordedRay> rays)
    : queries_(new Queries{scene.embree(), {}}) {
    queries_->rays.reserve(rays.size());
    for (const RecordedRay& r : rays) {
        Ray ray = r.ray;
        ray.o -= scene.origin();
        queries_->rays.push_back({EmbreeScene::ray_hit(ray), ray, r.occlusion});
    }
}

RayReplay::~RayReplay() = default;

std::size_t RayReplay::size() const { return queries_->rays.size(); }

std::uint64_t RayReplay::run(std::size_t first, std::size_t last) const {
    const EmbreeScene& scene = queries_->scene;
    std::uint64_t hits = 0;
    for (std::size_t i = first; i < last; ++i) {
        const Queries::Query& q = queries_->rays[i];
        EmbreeScene::Context context(scene, q.exact);
        RTCRayHit r = q.embree;
        if (q.occlusion) {
            embree_occluded(scene.handle(), context, r.ray);
            hits += r.ray.tfar < 0;
        } else {
            embree_intersect(scene.handle(), context, r);
            hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hits;
}

}  // namespace keyhole
