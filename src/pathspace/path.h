// Whole paths x_0 ... x_k, apart from how they were sampled: the contribution f and the densities of all techniques.
// Strategies that sample a path know both already as a throughput; this is the definition they are tested against, and
// what moves in path space use.
#pragma once

#include <span>
#include <vector>

#include "pathspace/connect.h"

namespace keyhole {

struct Path {
    std::vector<Vertex> x;  // k + 1 vertices, x[0] on the sensor, x[k] on an emitter

    int length() const { return static_cast<int>(x.size()) - 1; }
};

// A path as technique t made it, with all that its subpaths know: x_0 .. x_{t-1} as sampled from the eye and x_t .. x_k
// as sampled from the light.
struct SampledPath {
    std::vector<Vertex> room;  // the first k + 1 count
    int k = 0, t = 0;
    Junction junction;  // between x_{t-1} and x_t
    double weight = 0;  // w_t

    std::span<const Vertex> x() const { return {room.data(), static_cast<std::size_t>(k) + 1}; }
    std::span<const Vertex> eye() const { return {room.data(), static_cast<std::size_t>(t)}; }
    std::span<const Vertex> light() const { return {room.data() + t, static_cast<std::size_t>(k + 1 - t)}; }
};

// Joins an eye subpath and a light subpath (both in the path's order).
Path join(std::span<const Vertex> eye, std::span<const Vertex> light);

// The measurement contribution f(x) of the product area measure (vertices at infinity: solid angle). Positions and
// surface data decide; of how x was sampled only the lobe of delta events is used, whose Dirac factors are left out.
// Does not test visibility. Zero where shading and geometric sides disagree or the sensor does not see x_1.
Spectrum contribution(const Scene& scene, const Path& path);

// p_t(x) = product over i < t of eye[i] times product over i >= t of light[i]. eye[0] and light[k] hold the densities
// of the two endpoints; light[0] is 0, as no technique samples the sensor from the light. Dirac factors are left out.
struct PathDensities {
    std::vector<double> eye, light;
};
PathDensities densities(const Scene& scene, const RasterWindow& window, const Path& path);

// Whether technique t (vertices from the eye) can make the path: k = 1 only by t = 2; a connection's ends must scatter
// by smooth lobes; t = k + 1 needs an emitter that rays can hit.
bool technique_exists(std::span<const Vertex> x, int t);

}  // namespace keyhole
