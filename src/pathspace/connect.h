// Connecting an eye subpath x_0..x_{t-1} and a light subpath y_0..y_{s-1} into a path of k = s + t - 1 edges, and the
// balance-heuristic weight of the result.
#pragma once

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

// Subpaths as spans whose last vertex is the one connected. `light` may be empty (s = 0: the eye subpath must end on an
// emitter), and `eye` may hold the sensor alone (t = 1). k = 1 is sampled by s = 0 only.
// Everything that is cheap is tested before the shadow ray.
PathFailure connect(Tracer& tracer, const RasterWindow& window, const SensorPoint& sensor, std::span<const Vertex> eye,
                    std::span<const Vertex> light, Connection& c);

// Which of a path's techniques take part in the weights.
enum class Techniques {
    all,            // t = 1 .. k+1
    unidirectional  // t = k and k+1: next-event estimation and hitting the emitter
};

// w_t(x) = p_t / sum p_t', by the ratio recurrence p_{i+1} / p_i = eye_i / light_i along the path: no product over the
// whole path is ever formed.
double mis_weight(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                  Techniques techniques);

}  // namespace keyhole
