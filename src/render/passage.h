// The narrowest place of a bundle of edges.
#pragma once

#include <optional>
#include <vector>

#include "scene/portals.h"

namespace keyhole {

// Half-angle of double cones whose bound counts as a bottleneck, radians.
inline constexpr double widest_neck = 0.4;

// An edge of a path; `bound` limits the empty double cone about it, and `neck` is the edge's point beside that.
struct NarrowEdge {
    Vec3 from, to;
    Vec3 neck{0, 0, 0}, bound{0, 0, 0};
    double angle = widest_neck;  // of the cone; `widest_neck`: nothing bounds it
};

bool passes(const NarrowEdge& edge, const PortalFace& face);

// Where the edges pass the plane that the points that bound them lie in; or, if that is clearly narrower, another
// plane, found by turning and moving planes while the passage becomes smaller. Of crossings within `radius` of `about`;
// empty for fewer than 20 edges, or where fewer than nine of ten pass there.
std::optional<PortalFace> narrowest_passage(const std::vector<const NarrowEdge*>& edges, const Vec3& about,
                                            double radius);

}  // namespace keyhole
