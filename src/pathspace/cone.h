// The largest empty cone about an edge of a path [Otsu et al. 2018; theory, section 8].
#pragma once

#include <optional>
#include <vector>

#include "scene/box_hierarchy.h"

namespace keyhole {

enum class ConeEstimator {
    fast,     // corners of the boxes beside the edge
    bvh_cut,  // these boxes as a whole, the narrowest opened again and again
    exact     // down to triangles
};

struct ConeSettings {
    ConeEstimator estimator = ConeEstimator::bvh_cut;
    int boxes = 10;                        // N_max of bvh-cut: as many boxes are opened at most
    double t1 = 1e-4, t2 = 0.99;           // part of the edge's length that the cone covers
    double tau_min = 0.01, tau_max = 0.5;  // radians, bounds of the result
};

// An edge: `length` from the apex along the unit `axis`; `far_normal` is the unit normal of the surface at its end.
struct ConeEdge {
    Vec3 apex, axis;
    double length = 0;
    Vec3 far_normal;
};

// A function of the edge and the scene alone. One for each thread, for its room to work in.
class ConeFinder {
  public:
    ConeFinder(const BoxHierarchy& boxes, const ConeSettings& settings);

    // The half-angle in radians, within [tau_min, tau_max]. Where nothing lies beside the edge: tau_max.
    // `bvh-cut` is never above `exact`.
    double operator()(const ConeEdge& edge);

    // The point that bounds the exact cone, whatever the estimator; empty where none does within tau_max.
    std::optional<Vec3> contact(const ConeEdge& edge);

    const ConeSettings& settings() const { return settings_; }

  private:
    // A part of the scene, under the angle given or a larger one; `known`: exactly that one.
    struct Entry {
        double angle;
        const BoxHierarchy::Node* node;
        bool known;
    };
    struct Query;
    template <class Visit>
    void initial_cut(const Query& query, const Visit& visit);
    double fast(const Query& query);
    Entry refined(const Query& query, std::size_t boxes);
    void push(const Entry& entry);
    Entry pop();

    const BoxHierarchy* boxes_;
    ConeSettings settings_;
    std::vector<const BoxHierarchy::Node*> stack_;
    std::vector<Entry> queue_;
};

// The smallest angle from the axis under which the apex sees what lies of a triangle, or of a box, between the cone's
// two planes; infinite if nothing does. Parts that the axis itself meets do not count as angle zero.
double least_angle(const ConeEdge& edge, const ConeSettings& settings, const BoxHierarchy::Triangle& triangle);
double least_angle(const ConeEdge& edge, const ConeSettings& settings, const Vec3& lower, const Vec3& upper);

}  // namespace keyhole
