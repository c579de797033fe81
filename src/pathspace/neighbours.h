// What a vertex of a whole path sees of its neighbours: directions, measures and scattering, whichever end the path was
// sampled from.
#pragma once

#include <cmath>

#include "pathspace/vertex.h"
#include "scene/bsdf.h"

namespace keyhole {

// Unit direction from a finite vertex to its neighbour.
inline Vec3 direction(const Vertex& from, const Vertex& to) {
    return to.infinite ? to.x.p : Vec3((to.x.p - from.x.p).normalized());
}

// Turns a solid-angle density at a vertex into the density of its neighbour `to` (and, squared distance and far cosine,
// is that end's share of the geometry term). `d` is the unit direction of the edge.
inline double to_measure(const Vertex& from, const Vertex& to, const Vec3& d) {
    if (to.infinite) return 1;
    const double cosine = to.x.ng.isZero() ? 1 : std::abs(to.x.ng.dot(d));
    return from.infinite ? cosine : cosine / (to.x.p - from.x.p).squaredNorm();
}

// Scattering at a vertex between its neighbours.
struct Scattering {
    Spectrum f{0, 0, 0};  // with |ns.w_light| / |ng.w_light|
    double pdf_light = 0, pdf_eye = 0;
};

inline Scattering scattering(const Vertex& v, const Vec3& to_eye, const Vec3& to_light) {
    const Vec3 we = v.x.frame.to_local(to_eye), wl = v.x.frame.to_local(to_light);
    const double ge = v.x.ng.dot(to_eye), gl = v.x.ng.dot(to_light);
    if (!same_side(ge, we.z()) || !same_side(gl, wl.z())) return {};
    const double correction = std::abs(wl.z() / gl);
    if (v.delta) return {v.delta_f * correction, v.delta_pdf_light, v.delta_pdf_eye};
    const BsdfValue value = v.x.bsdf->eval(v.x, we, wl);
    return {value.f * correction, value.pdf_light, value.pdf_eye};
}

}  // namespace keyhole
