// Steps as large as the empty cone about an edge [Otsu et al. 2018].
#pragma once

#include <array>

#include "pathspace/cone.h"
#include "strategies/perturbation.h"

namespace keyhole {

// r_max: the cone's half-angle; r_min: alpha times that. For one thread.
class ConeStepSize final : public StepSize {
  public:
    ConeStepSize(const Scene& scene, const ConeSettings& settings, double alpha)
        : finder_(scene.boxes(), settings), diameter_(2 * scene.radius()), alpha_(alpha) {}

    DirectionKernel operator()(const Vertex& from, const Vertex& to) const override {
        const double r_max = cone(from.x.p, to);
        return {alpha_ * r_max, r_max};
    }

    bool from_geometry() const override { return true; }

  private:
    // A proposal asks for its two edges more than once, and the next one starts from one of them.
    struct Known {
        Vec3 from{0, 0, 0}, to{0, 0, 0};
        double angle = 0;
    };
    double cone(const Vec3& from, const Vertex& to) const {
        for (const Known& k : known_)
            if (k.angle > 0 && k.from == from && k.to == to.x.p) return k.angle;
        ConeEdge edge{from, to.x.p, diameter_, to.x.ng};
        if (!to.infinite) {
            edge.axis -= from;
            edge.length = edge.axis.norm();
            edge.axis /= edge.length;
        }
        if (edge.far_normal.isZero()) edge.far_normal = edge.axis;
        const double angle = finder_(edge);
        known_[oldest_] = {from, to.x.p, angle};
        oldest_ = (oldest_ + 1) % known_.size();
        return angle;
    }

    mutable ConeFinder finder_;
    double diameter_, alpha_;
    mutable std::array<Known, 8> known_;
    mutable std::size_t oldest_ = 0;
};

}  // namespace keyhole
