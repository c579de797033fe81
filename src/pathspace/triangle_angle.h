// Under which angle from an edge the edge's apex sees a triangle.
#pragma once

#include "pathspace/cone.h"

namespace keyhole {

// The space between the cone's planes, from the apex: t1 L <= w.p, and n.(p - t2 L w) <= 0 with n towards the far end.
struct ConeSlab {
    Vec3 w, n;
    double near, far;

    ConeSlab(const ConeEdge& edge, const ConeSettings& settings)
        : w(edge.axis),
          n(edge.far_normal.dot(edge.axis) < 0 ? Vec3(-edge.far_normal) : edge.far_normal),
          near(settings.t1 * edge.length),
          far(settings.t2 * edge.length * n.dot(edge.axis)) {}
    double before_near(const Vec3& p) const { return near - w.dot(p); }  // <= 0 inside
    double behind_far(const Vec3& p) const { return n.dot(p) - far; }    // <= 0 inside
    bool holds(const Vec3& p) const { return before_near(p) <= 0 && behind_far(p) <= 0; }
};

// The smallest angle from the axis, by its tangent, under which the apex sees what lies of a triangle in the slab;
// infinite if nothing does. Parts that the axis itself meets do not count as angle zero.
double least_tangent(const ConeSlab& slab, const Vec3& apex, const BoxHierarchy::Triangle& triangle);

// The point that is seen so. Meaningless if nothing of the triangle lies in the slab.
Vec3 nearest_to_axis(const ConeSlab& slab, const Vec3& apex, const BoxHierarchy::Triangle& triangle);

}  // namespace keyhole
