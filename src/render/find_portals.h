// Proposes portals for a scene: rectangles over the openings that its light passes through.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace keyhole {

struct PortalSearch {
    std::int64_t tries = 2000000;  // paths drawn at most
    int paths = 40000;             // paths with light that are enough; a few thousand of them are looked at
    int most = 8;                  // portals proposed at most
    double least_share = 0.05;     // of the light, that passes a portal
    int max_length = 0;            // 0: what the scene says, else 8
    std::int64_t seed = 0;
};

struct FoundPortal {
    PortalFace face;         // a rectangle
    double share = 0;        // of the sampled light, that passes it
    double paths_share = 0;  // of the sampled paths
};

struct FoundPortals {
    std::vector<FoundPortal> portals;  // the one that most light passes first
    std::int64_t tries = 0;
    int paths = 0;
};

// Draws paths as the bootstrap does, and looks for the bottleneck of each edge: what bounds the largest empty double
// cone about it. Where bottlenecks crowd, an opening is: a plane is fitted to the points of the scene that bound them,
// and a rectangle of the smallest area around those. Edges that pass it are then left out, and the next one is looked
// for.
FoundPortals find_portals(
    const Scene& scene, const PortalSearch& search, const std::function<bool()>& stop = [] { return false; });

// As a scene file of portals; `comment` says where it is from.
std::string portals_xml(const FoundPortals& found, const std::string& comment);

}  // namespace keyhole
