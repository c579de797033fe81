// What moves in path space need of a whole path: f*(x) and the densities of every vertex from both of its sides.
#pragma once

#include <vector>

#include "pathspace/path.h"

namespace keyhole {

// By index in the path, 0 to k; room for the longest path of a mix.
struct PathMeasure {
    std::vector<double> eye, light;  // densities as PathDensities
    std::vector<double> peak;        // of x_1 .. x_{k-1}: the larger of the solid-angle densities by which the vertex
                                     // draws its two directions from each other; infinite at delta events
    double log_f = 0;                // ln f*(x), in the product area measure: f* itself may leave the range of double
    Spectrum color{0, 0, 0};         // f / f*
    Vec2 raster{0, 0};

    explicit PathMeasure(int max_length = -1) : eye(static_cast<std::size_t>(max_length + 1)), light(eye), peak(eye) {}
};

// Casts no ray: visibility is the caller's matter. All of m is unspecified after a failure.
PathFailure measure(const Scene& scene, const RasterWindow& window, TargetFunction target, std::span<const Vertex> x,
                    PathMeasure& m);

// Makes `path` (k and its vertices) one as technique t sampled it, with the first t of the set that can, and returns
// C(x) = f* / sum p_t; 0 where none can.
double adopt_technique(TechniqueSet techniques, const PathMeasure& m, SampledPath& path);

}  // namespace keyhole
