// The right inverse R_t of a chart: coordinates by which technique t makes a given path, drawn such that the path's
// distribution and that of its coordinates belong together (theory, sections 2 and 4).
#pragma once

#include <cstdint>
#include <span>

#include "base/rng.h"
#include "pss/chart.h"

namespace keyhole {

enum class InverseFailure : std::uint8_t {
    none,
    impossible,  // the technique never makes such a path: a connection at a delta lobe, an emitter that no ray can hit
    sensor,      // the sensor does not see x_1
    emitter,     // the emitter does not draw x_k, or not the ray from there to x_{k-1}
    bsdf,        // a vertex does not draw the direction to the next one
    retrace      // the coordinates do not lead back to the path
};

struct Inversion {
    InverseFailure failure = InverseFailure::none;
    int vertex = 0;  // whose sampler failed: 0 for the sensor, k for the emitter
};

// x: the vertices x_0 ... x_k of a path with light, as sampled by any technique; k >= 2, t in [1, k+1]. Sets u's
// coordinates for (k, t). Numbers that the chart does not read for this path are drawn fresh.
Inversion invert(const Scene& scene, const RasterWindow& window, const CoordinateLayout& layout,
                 std::span<const Vertex> x, int t, PrimarySample& u, Rng& rng);

// How far vertex i of a traced path is from x_i: in units of the width 1 / sqrt(density) of what sampled it, or seen
// from the vertex before in radians, whichever is more. Infinite where it is not of the same kind.
double deviation(const SampledPath& traced, std::span<const Vertex> x, int i);
// The largest of all vertices.
double deviation(const SampledPath& traced, std::span<const Vertex> x);

// Of paths that count as the same. Rounding is far below, another path far above.
inline constexpr double largest_deviation = 1e-3;

}  // namespace keyhole
