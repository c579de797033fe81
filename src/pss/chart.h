// The map T_t from primary sample space to paths, one chart per technique.
#pragma once

#include <vector>

#include "base/lanes.h"
#include "pathspace/path.h"
#include "pss/layout.h"

namespace keyhole {

// A point of the chart t of paths with k edges. The layout's count(k, t) coordinates, those of the eye first; there is
// room for its capacity, in whole lanes, and what lies behind the count has no meaning.
struct PrimarySample {
    int k = 0, t = 0;
    std::vector<double> coordinates;

    explicit PrimarySample(const CoordinateLayout& layout) : coordinates(whole_lanes(layout.capacity())) {}
    int s() const { return k + 1 - t; }
    double* data() { return coordinates.data(); }
    const double* data() const { return coordinates.data(); }
};

// What the chain needs of T_t(u).
struct Evaluation {
    PathFailure failure = PathFailure::none;
    Spectrum contribution{0, 0, 0};  // w_t f / p_t
    double target = 0;               // f* of it, which is C(x); 0 after a failure
    Vec2 raster{0, 0};
    double weight = 0;  // w_t
};

// What is weighted by w_t: the target, which is then C(x) = w_t f* / p_t [Pantaleoni 2017, equation 14], or only what
// is splatted, while the target is f* / p_t [equation 12].
enum class Weighting { target, splat };

// What a chart takes as the target.
struct ChartTarget {
    TargetFunction function = TargetFunction::luminance;
    TechniqueSet techniques = all_techniques;
    Weighting weighting = Weighting::target;
};

// Maps coordinates to paths. Has the room for one path, so one per thread.
class Chart {
  public:
    Chart(const Scene& scene, const CoordinateLayout& layout, const ChartTarget& target = {});

    // Traces T_t(u) into `path`, which has room for max_length + 1 vertices; unspecified after a failure.
    // k in [1, max_length], t in [1, k+1] of the target's techniques; t = 1 with k = 1 has zero contribution by
    // convention.
    Evaluation evaluate(const PrimarySample& u, SampledPath& path);
    // Into the chart's own path.
    Evaluation evaluate(const PrimarySample& u) { return evaluate(u, path_); }
    const SampledPath& path() const { return path_; }

    Tracer& tracer() { return tracer_; }
    const RasterWindow& window() const { return window_; }
    const CoordinateLayout& layout() const { return *layout_; }
    const ChartTarget& target() const { return target_; }

  private:
    // `u`: the subpath's coordinates.
    PathFailure trace_eye(const double* u, SampledPath& path);
    PathFailure trace_light(const double* u, SampledPath& path);

    Tracer tracer_;
    const CoordinateLayout* layout_;
    ChartTarget target_;
    RasterWindow window_;
    SampledPath path_;
    Vertex pinhole_;  // x_0, where there is no lens
    Vec2 raster_{0, 0};
};

}  // namespace keyhole
