// The empty cones about primary edges, as an image [Otsu et al. 2018, figure 13].
#pragma once

#include "pathspace/cone.h"
#include "render/image.h"
#include "scene/scene.h"

namespace keyhole {

struct ConeImage {
    Image angles;            // of the crop window's pixels, through their centres; radians in all channels, 0: no edge
    double mean_ratio = 0;   // of the angles to the exact ones
    double worst_ratio = 0;  // the farthest from 1
    double seconds = 0, seconds_exact = 0;  // of one query, on one thread
    std::size_t edges = 0;
};

// Throws std::invalid_argument for an orthographic sensor: its edges have no apex.
ConeImage cone_image(const Scene& scene, const ConeSettings& settings);

}  // namespace keyhole
