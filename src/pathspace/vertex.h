// Vertices of paths and subpaths.
//
// Measures: densities of surface vertices are with respect to area; those of vertices at infinity (environment and
// directional emitters, an orthographic sensor) with respect to solid angle, or 1 where the direction is fixed. The
// density of the vertex next to one at infinity is the density on the plane perpendicular to the edge times its cosine.
//
// Delta lobes: their Dirac factor is the same from both sides in the measure eta^2 |cos| dw (eta the index of
// refraction on w's side over the one on the eye's side). A delta event of probability P therefore counts as the
// solid-angle density P eta^2 |cos w| of its sampled direction, and f as the lobe's coefficient: the Dirac factors left
// out are the same in every technique and in f, so they cancel exactly in every ratio.
#pragma once

#include "base/spectrum.h"
#include "scene/emitter.h"
#include "scene/sensor.h"
#include "scene/surface.h"

namespace keyhole {

struct Vertex {
    SurfacePoint x;  // endpoints: only p (a direction, if infinite), ng, uv, offset, emitter

    // Of the subpath the vertex was sampled on; "previous" is the neighbour nearer to that subpath's start.
    Vec3 w_prev;                   // unit direction to the previous vertex, in the local shading frame
    double cos_prev = 0;           // its cosine with ng, signed
    double to_prev = 0;            // turns a solid-angle density here into the density of the previous vertex
    double pdf_fwd = 0;            // density of this vertex as sampled
    double pdf_rev = 0;            // its density if sampled from the other end; set by the vertex after next
    Spectrum throughput{0, 0, 0};  // contribution over density of the subpath that arrives here
    Spectrum delta_f{0, 0, 0};     // delta events only: f and
    double delta_pdf_eye = 0, delta_pdf_light = 0;  // densities of both directions in the sense above
    bool infinite = false;                          // x.p is a unit direction away from the scene
    bool delta = false;                             // scatters by a delta lobe: cannot be connected
    std::uint8_t lobe = 0;                          // delta events only: BsdfSample::lobe
};

inline SensorPoint sensor_point(const Vertex& x0) { return {x0.x.p, x0.pdf_fwd}; }
inline EmitterPoint emitter_point(const Vertex& v) {
    return {v.x.p, v.x.ng, v.x.uv, v.pdf_fwd, v.x.offset, v.x.offset_per_length, v.x.primitive};
}

// A vertex on no surface, for rays to start from.
inline Vertex free_vertex(const Vec3& p) {
    Vertex v;
    v.x.p = p;
    v.x.ng = Vec3::Zero();
    v.x.bsdf = nullptr;
    v.x.emitter = nullptr;
    return v;
}

// Whether shading and geometric side of a direction agree. Where they do not, every strategy rejects.
inline bool same_side(double cos_geometric, double cos_shading) { return cos_geometric * cos_shading > 0; }

}  // namespace keyhole
