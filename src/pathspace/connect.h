// Connecting an eye subpath x_0 .. x_{t-1} and a light subpath x_t .. x_k into a path of k edges, s = k + 1 - t, and
// the balance-heuristic weights of the result. Subpaths are spans in the path's order: the eye's ends and the light's
// begins with the vertex that is connected.
#pragma once

#include <limits>
#include <span>

#include "pathspace/subpath.h"

namespace keyhole {

enum class PathFailure : std::uint8_t {
    none,
    eye_subpath_short,
    light_subpath_short,
    occluded,
    zero_bsdf,  // or a shading-normal conflict, or an emitter seen from behind
    outside_film,
    non_finite
};

// Densities that the connection alone determines; i counts from the sensor. Those of vertices that the path does not
// have are unspecified.
struct Junction {
    double light_t1;  // of x_{t-1}, sampled from the light side
    double light_t2;  // of x_{t-2}
    double eye_t;     // of x_t, sampled from the eye side
    double eye_t1;    // of x_{t+1}
};

// All unspecified after a failure.
struct Connection {
    Spectrum throughput;  // f / p_t
    Vec2 raster;          // set where the connection decides it: t == 1
    Junction junction;
};

// `light` may be empty (s = 0: the eye subpath must end on an emitter), and `eye` may hold the sensor alone (t = 1).
// k = 1 is sampled by s = 0 only.
// Everything that is cheap is tested before the shadow ray.
PathFailure connect(Tracer& tracer, const RasterWindow& window, std::span<const Vertex> eye,
                    std::span<const Vertex> light, Connection& c);

// Whether an edge may end at a vertex on a surface that no direction was drawn for.
inline bool has_smooth_lobe(const Vertex& v) { return v.x.bsdf && v.x.bsdf->traits().smooth; }
inline bool connectable(const Vertex& v) { return !v.delta && has_smooth_lobe(v); }

// Whether nothing lies between two neighbours of a path, `x` the one nearer to the sensor, which may be the sensor. Not
// both are endpoints.
bool visible(Tracer& tracer, const Vertex& x, const Vertex& y);

// Which techniques take part in the weights: those with so many vertices from the light.
struct TechniqueSet {
    int min_light = 0, max_light = std::numeric_limits<int>::max();

    bool holds(int s) const { return min_light <= s && s <= max_light; }
    bool operator==(const TechniqueSet&) const = default;
};
inline constexpr TechniqueSet all_techniques{};
inline constexpr TechniqueSet unidirectional_techniques{0, 1};  // hitting the emitter and next-event estimation

// w_t(x) = p_t / sum p_t', by the ratio recurrence p_{i+1} / p_i = eye_i / light_i along the path: no product over the
// whole path is ever formed. Technique t itself must belong to the set.
double mis_weight(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                  TechniqueSet techniques);

// The same of all techniques: weights[t' - 1] = w_t'(x) for t' in [1, k+1]; 0 for those that cannot make the path or do
// not belong to the set. Room for k + 1 weights.
void mis_weights(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                 TechniqueSet techniques, std::span<double> weights);

}  // namespace keyhole
