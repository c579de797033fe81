// Subpaths sampled from the sensor or from an emitter, vertex by vertex.
#pragma once

#include "pathspace/tracer.h"
#include "pathspace/vertex.h"
#include "scene/bsdf.h"

namespace keyhole {

// Raster positions are uniform over this window: the crop window and a border as wide as the filter reaches over.
struct RasterWindow {
    Vec2 origin, size;

    explicit RasterWindow(const FilmSettings& film);
    double area() const { return size.x() * size.y(); }
    Vec2 at(const Vec2& u) const { return origin + size.cwiseProduct(u); }
    Vec2 to_unit(const Vec2& r) const {
        const Vec2 u = (r - origin).cwiseQuotient(size);
        return {clamp01(u.x()), clamp01(u.y())};
    }
    bool contains(const Vec2& r) const {
        const double x = r.x() - origin.x(), y = r.y() - origin.y();
        return x >= 0 && y >= 0 && x < size.x() && y < size.y();
    }
};

enum class Extension {
    surface,   // the next vertex lies on a surface
    escaped,   // the ray left the scene; the next vertex is at infinity if the scene has an environment
    absorbed,  // nothing is scattered
    dark       // on a surface that emits nothing, where only emitters were wanted; the next vertex is not filled
};

// x_0 of an eye subpath. `u` is read only by sensors with an aperture.
void start_eye(const Scene& scene, const Vec2& u, Vertex& x0);
// x_1, by the ray through a raster position.
Extension first_eye_edge(Tracer& tracer, const RasterWindow& window, const Vec2& raster, Vertex& x0, Vertex& x1,
                         Wanted wanted = Wanted::surface);

// y_0 of a light subpath. Returns false if the scene has no emitter or the drawn point emits nothing.
bool start_light(const Scene& scene, double u_choice, double u_part, const Vec2& u, Vertex& y0);
// y_1, by the ray that leaves the emitter.
Extension first_light_edge(Tracer& tracer, const Vec2& u, Vertex& y0, Vertex& y1);

// The vertex after `v`. `u_lobe` chooses the lobe, `u` the direction. Sets v's event, prev's reverse density and `next`
// up to its reverse density.
Extension extend(Tracer& tracer, Mode mode, Vertex& prev, Vertex& v, Vertex& next, double u_lobe, const Vec2& u,
                 Wanted wanted = Wanted::surface);

// The vertex that the ray from a finite vertex (on a surface or an emitter's endpoint) meets in the unit direction d.
// `next` has no densities, and the throughput 1.
Extension trace_from(Tracer& tracer, const Vertex& v, const Vec3& d, Vertex& next);

// Makes a vertex of a path one that `extend` can go on from, away from its neighbour `prev`; with the throughput 1.
void orient(const Vertex& prev, Vertex& v);

}  // namespace keyhole
