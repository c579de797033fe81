// Perturbations: part of a path is traced again, with a small change of direction where it leaves a rough vertex, and
// as before through chains of specular ones, until it can be connected to what is kept [Veach and Guibas 1997, 5.3].
//
// Along a chain the numbers are kept by which its vertices draw their directions, from the exact inverse: in these
// coordinates the chain does not change, so its share of T(x -> y) is the density by which each direction is drawn, as
// in f* / p of a move in primary sample space (theory, section 4). That holds for mirrors and for rough vertices alike.
#pragma once

#include <memory>

#include "pathspace/direction_kernel.h"
#include "strategies/path_move.h"

namespace keyhole {

// How large the steps about an edge may be. Must be a function of the edge alone: the way back asks for it with the
// edge of y.
class StepSize {
  public:
    virtual ~StepSize() = default;
    // Of directions about the edge between two vertices of a path, seen from the first.
    virtual DirectionKernel operator()(const Vertex& from, const Vertex& to) const = 0;
    // Whether it looks at the scene about the edge: strategies have names of their own then.
    virtual bool from_geometry() const { return false; }
};

class FixedStepSize final : public StepSize {
  public:
    FixedStepSize(double r_min, double r_max) : kernel_{r_min, r_max} {}
    DirectionKernel operator()(const Vertex&, const Vertex&) const override { return kernel_; }

  private:
    DirectionKernel kernel_;
};

// Sizes in raster space instead of by angle, in pixels.
struct RasterStep {
    bool used = false;
    double r_min = 0.1, r_max = 0;  // r_max 0: the radius of a disk of a twentieth of the film's area
};

class Perturbation : public PathMove {
  protected:
    // Vertices that pass light on in a lobe as narrow as that of a facet distribution of roughness `roughness` or
    // narrower count as specular: by the density in the middle of that lobe, 1 / (4 pi roughness^2).
    Perturbation(ChartEvaluator& charts, double roughness)
        : PathMove(charts), narrowest_(1 / (4 * pi * roughness * roughness)) {}

    RasterStep resolved(RasterStep raster) const {
        if (raster.r_max <= 0) raster.r_max = std::max(2 * raster.r_min, std::sqrt(0.05 / pi * window().area()));
        return raster;
    }

    bool specular(const PathMeasure& m, int i) const { return m.peak[static_cast<std::size_t>(i)] > narrowest_; }

    // ln of T's factors, forth and back.
    struct Densities {
        double forth = 0, back = 0;
    };

    // y_{i + step} from y_i, by a direction about the one that x leaves x_i in; `step` is 1 from the eye, -1 from the
    // light.
    Failure perturb(const PssState& x, PssState& y, int i, int step, const DirectionKernel& kernel, Rng& rng) const;
    // y_{i + step} from y_i, by the numbers that x_i draws its direction by.
    Failure follow(const PssState& x, PssState& y, int i, int step, Rng& rng) const;
    // Of the vertices that perturb() and follow() made, where y is complete.
    static void add_perturbed(const PssState& x, const PssState& y, int i, int step, const DirectionKernel& at_x,
                              const DirectionKernel& at_y, Densities& densities);
    static void add_followed(const PssState& x, const PssState& y, int i, int step, Densities& densities);

    // What became of the ray from y_i, which only the emitter may be reached by without a surface.
    static Failure arrived(const PssState& y, int i, int step, Extension extension);

  private:
    double narrowest_;
};

}  // namespace keyhole
