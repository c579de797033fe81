// The map T_t from primary sample space to paths, one chart per technique.
#pragma once

#include <vector>

#include "base/lanes.h"
#include "pathspace/connect.h"
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

// Maps coordinates to paths. Owns the vertices, so one per thread.
class Chart {
  public:
    Chart(const Scene& scene, const CoordinateLayout& layout, TargetFunction target = TargetFunction::luminance);

    // Traces T_t(u). k in [1, max_length], t in [1, k+1]; t = 1 with k = 1 has zero contribution by convention.
    Evaluation evaluate(const PrimarySample& u);

    // The vertices of the last evaluation that did not fail.
    std::span<const Vertex> eye() const { return {eye_.data(), static_cast<std::size_t>(t_)}; }
    std::span<const Vertex> light() const { return {light_.data(), static_cast<std::size_t>(s_)}; }
    const SensorPoint& sensor_point() const { return sensor_point_; }
    const Junction& junction() const { return connection_.junction; }

    Tracer& tracer() { return tracer_; }
    const RasterWindow& window() const { return window_; }
    const CoordinateLayout& layout() const { return *layout_; }

  private:
    // `u`: the subpath's coordinates.
    PathFailure trace_eye(const double* u);
    PathFailure trace_light(const double* u);

    Tracer tracer_;
    const CoordinateLayout* layout_;
    TargetFunction target_;
    RasterWindow window_;
    std::vector<Vertex> eye_, light_;
    SensorPoint sensor_point_;
    Connection connection_;
    Vec2 raster_{0, 0};
    int t_ = 0, s_ = 0;
};

}  // namespace keyhole
