// Recorded rays, cast again through Embree alone: what tracing costs without anything around it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "scene/scene.h"

namespace keyhole {

struct RecordedRay {
    Ray ray;
    bool occlusion;  // any hit, not the nearest
};

class RayReplay {
  public:
    // Converts the rays to Embree's own format beforehand.
    RayReplay(const Scene& scene, std::span<const RecordedRay> rays);
    ~RayReplay();

    // Casts rays first to last-1 in order and returns how many hit.
    std::uint64_t run(std::size_t first, std::size_t last) const;
    std::size_t size() const;

  private:
    struct Queries;
    std::unique_ptr<Queries> queries_;
};

}  // namespace keyhole
