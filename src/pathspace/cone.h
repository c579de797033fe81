// The largest empty cone about an edge of a path [Otsu et al. 2018; theory, section 8].
#pragma once

#include <optional>
#include <vector>

#include "scene/box_hierarchy.h"

namespace keyhole {

enum class ConeEstimator {
    fast,     // corners of the boxes beside the edge
    bvh_cut,  // bounds for these boxes as a whole, the narrowest opened as long as there are few
    exact     // down to triangles
};

struct ConeSettings {
    ConeEstimator estimator = ConeEstimator::bvh_cut;
    int boxes = 10;                        // N_max of bvh-cut: from as many on, none is opened
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
    // What the box of a lane holds, seen under an angle of the given tangent or a larger one; `exact`: that one.
    struct Entry {
        double tangent;
        const BoxHierarchy::Node* node;
        int lane;
        bool exact;
    };
    struct Query;
    template <class Visit>
    void visit_met(const Query& query, const Visit& visit);
    double fast(const Query& query);
    Entry refined(const Query& query, std::size_t boxes);

    const BoxHierarchy* boxes_;
    ConeSettings settings_;
    double tan_tau_;  // of tau_max
    std::vector<const BoxHierarchy::Node*> stack_;
    std::vector<Entry> queue_;
};

}  // namespace keyhole
