// The portal perturbation [Otsu et al. 2020]: turns an edge that passes a portal about its point there, and both of its
// ends go along. Ratio: theory, section 6.
#pragma once

#include "strategies/eye_perturbation.h"

namespace keyhole {

// How the point on the portal moves; all symmetric in the portal's area.
struct PortalPoint {
    enum class Move { fixed, gaussian, uniform } move = Move::fixed;
    double sigma = 0;  // gaussian: standard deviation in units of the square root of the portal's area

    // Empty where a step leaves the face that it starts on.
    std::optional<Portals::Point> operator()(const Portals& portals, const Portals::Point& c, Rng& rng) const;
};

// An edge x_i x_{i+1} of a path and the point where it passes a portal.
struct PortalCrossing {
    int edge = 0;
    Portals::Point point;
};

// Crossings that a move may choose from, each with the same probability.
class PortalCrossings {
  public:
    enum class Edges { nearest, any };
    PortalCrossings(const Scene& scene, Edges edges) : scene_(scene), edges_(edges) {}

    int count(const SampledPath& path) const;
    PortalCrossing choose(const SampledPath& path, int count, Rng& rng) const;
    // Whether it is one of those; its point is where the path has it now.
    bool holds(const SampledPath& path, int edge, std::uint32_t face) const;

    // Calls visit(point) for the crossings of one edge, whose ends can both be moved, or the far one alone.
    template <class Visit>
    static void for_edge(const Scene& scene, const SampledPath& path, int edge, const Visit& visit);
    // Whether x_{i+1} can be met by a ray, and be connected to the vertex behind.
    static bool far_end_moves(const SampledPath& path, int edge);

  private:
    template <class Visit>
    void for_all(const SampledPath& path, const Visit& visit) const;

    const Scene& scene_;
    Edges edges_;
};

// Chooses a crossing of an edge x_p x_{p+1} with p >= 1, whose ends and their neighbours scatter by smooth lobes, or
// x_{p+1} is an emitter that rays can meet.
class PortalPerturbation final : public PathMove {
  public:
    PortalPerturbation(ChartEvaluator& charts, PortalCrossings::Edges edges, const PortalPoint& point,
                       const DirectionKernel& kernel)
        : PathMove(charts), crossings_(scene(), edges), point_(point), kernel_(kernel) {}
    std::string_view name() const override { return "portal"; }
    double suitability(const PssState& x) const override {
        return charts_.measure(x) && crossings_.count(x.path) > 0 ? 1 : 0;
    }
    bool suitability_varies() const override { return true; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

    // ln of dA_c dsigma over dA_p dA_{p+1}: the edge's geometry term over the portal's cosine.
    double log_jacobian(const PssState& x, int edge, std::uint32_t face) const;

  private:
    Failure pivot(const PssState& x, PssState& y, int edge, const Portals::Point& c, Rng& rng) const;

    PortalCrossings crossings_;
    PortalPoint point_;
    DirectionKernel kernel_;
};

// The lens perturbation of a path whose edge after the first rough vertex x_b passes a portal: x_b moves, and the edge
// goes on from there through the portal's point, so that x_{b+1} goes along. With J = dA_{b+1} / dA_c the density of
// y_{b+1} is that of the point over J.
class PortalLens final : public EyePerturbation {
  public:
    PortalLens(ChartEvaluator& charts, std::unique_ptr<const StepSize> size, double roughness, const RasterStep& raster,
               const PortalPoint& point)
        : EyePerturbation(charts, Chains::one, std::move(size), roughness, raster), point_(point) {}
    std::string_view name() const override { return "portal-lens"; }
    double suitability(const PssState& x) const override;
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    int count(const PssState& x, int edge) const;
    double log_jacobian(const PssState& x, int edge, const Portals::Point& c) const;

    PortalPoint point_;
};

}  // namespace keyhole
