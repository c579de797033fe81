#include "strategies/portal.h"

#include <cmath>

#include "pathspace/neighbours.h"

namespace keyhole {

std::optional<Portals::Point> PortalPoint::operator()(const Portals& portals, const Portals::Point& c, Rng& rng) const {
    const PortalFace& face = portals.faces()[c.face];
    switch (move) {
        case Move::fixed:
            return c;
        case Move::gaussian: {
            const double r = sigma * std::sqrt(portals.area(face.portal)) * std::sqrt(-2 * std::log1p(-rng.uniform()));
            const double phi = 2 * pi * rng.uniform();
            const Frame frame = Frame::from_normal(face.n);
            const Vec3 p = c.p + r * (std::cos(phi) * frame.s + std::sin(phi) * frame.t);
            const Vec2 ab = face.coordinates(p);
            return face.holds(ab) ? std::optional(Portals::Point{c.face, p}) : std::nullopt;
        }
        case Move::uniform: {
            const double u_face = rng.uniform(), first = rng.uniform();
            return portals.sample(face.portal, u_face, {first, rng.uniform()});
        }
    }
    return std::nullopt;
}

template <class Visit>
void PortalCrossings::for_edge(const Scene& scene, const SampledPath& path, int edge, const Visit& visit) {
    const Vertex &from = path.room[static_cast<std::size_t>(edge)], &to = path.room[static_cast<std::size_t>(edge) + 1];
    const Vec3 d = direction(from, to);
    const double length = to.infinite ? std::numeric_limits<double>::infinity() : (to.x.p - from.x.p).norm();
    const std::span<const PortalFace> faces = scene.portals().faces();
    for (std::uint32_t i = 0; i < faces.size(); ++i)
        if (const auto ab = faces[i].crossing(from.x.p, d, length)) visit(Portals::Point{i, faces[i].at(*ab)});
}

bool PortalCrossings::far_end_moves(const SampledPath& path, int edge) {
    const auto v = [&](int i) -> const Vertex& { return path.room[static_cast<std::size_t>(i)]; };
    if (edge + 1 == path.k) {
        const EmitterTraits& emitter = v(path.k).x.emitter->traits();
        return emitter.surface || emitter.environment;
    }
    return !v(edge + 1).delta && (edge + 2 == path.k || !v(edge + 2).delta);
}

template <class Visit>
void PortalCrossings::for_all(const SampledPath& path, const Visit& visit) const {
    for (int p = 1; p < path.k; ++p) {
        const auto v = [&](int i) -> const Vertex& { return path.room[static_cast<std::size_t>(i)]; };
        if (v(p).delta || (p > 1 && v(p - 1).delta) || !far_end_moves(path, p)) continue;
        bool any = false;
        for_edge(scene_, path, p, [&](const Portals::Point& c) {
            any = true;
            visit(PortalCrossing{p, c});
        });
        if (any && edges_ == Edges::nearest) return;
    }
}

int PortalCrossings::count(const SampledPath& path) const {
    int n = 0;
    for_all(path, [&](const PortalCrossing&) { ++n; });
    return n;
}

PortalCrossing PortalCrossings::choose(const SampledPath& path, int count, Rng& rng) const {
    PortalCrossing chosen;
    int left = static_cast<int>(rng.below(static_cast<std::uint64_t>(count)));
    for_all(path, [&](const PortalCrossing& c) {
        if (left-- == 0) chosen = c;
    });
    return chosen;
}

bool PortalCrossings::holds(const SampledPath& path, int edge, std::uint32_t face) const {
    bool found = false;
    for_all(path, [&](const PortalCrossing& c) { found = found || (c.edge == edge && c.point.face == face); });
    return found;
}

double PortalPerturbation::log_jacobian(const PssState& x, int edge, std::uint32_t face) const {
    const Vertex &from = at(x, edge), &to = at(x, edge + 1);
    const Vec3 d = direction(from, to);
    const double g = std::abs(from.x.ng.dot(d)) * to_measure(from, to, d);
    return std::log(g / std::abs(scene().portals().faces()[face].n.dot(d)));
}

Failure PortalPerturbation::pivot(const PssState& x, PssState& y, int edge, const Portals::Point& c, Rng& rng) const {
    keep(x, y);
    const int k = y.path.k;
    const double first = rng.uniform();
    const Vec3 d = kernel_.sample(direction(at(x, edge), at(x, edge + 1)), {first, rng.uniform()});
    Vertex* const v = y.path.room.data() + edge;
    const Vertex pivot = free_vertex(c.p);
    if (trace_from(tracer(), pivot, -d, v[0]) != Extension::surface || !connectable(v[0]))
        return Failure::eye_subpath_short;
    const Extension e = trace_from(tracer(), pivot, d, v[1]);
    const bool last = edge + 1 == k;
    if (last ? !v[1].x.emitter : e != Extension::surface || !connectable(v[1])) return Failure::light_subpath_short;
    if (const PathFailure failure = charts_.complete(y); failure != PathFailure::none) return to_failure(failure);
    if (!crossings_.holds(y.path, edge, c.face)) return Failure::outside_support;
    return visible(tracer(), v[-1], v[0]) && (last || visible(tracer(), v[1], v[2])) ? Failure::none
                                                                                     : Failure::occluded;
}

Proposal PortalPerturbation::propose(PssState& x, PssState& y, Rng& rng) const {
    const int n = crossings_.count(x.path);
    const PortalCrossing crossing = crossings_.choose(x.path, n, rng);
    const auto c = point_(scene().portals(), crossing.point, rng);
    if (!c) return Proposal::failed(Failure::outside_support);
    if (const Failure failure = pivot(x, y, crossing.edge, *c, rng); failure != Failure::none)
        return Proposal::failed(failure);
    return proposal(x, y, log_jacobian(y, crossing.edge, c->face) - std::log(n),
                    log_jacobian(x, crossing.edge, crossing.point.face) - std::log(crossings_.count(y.path)));
}

int PortalLens::count(const PssState& x, int edge) const {
    int n = 0;
    PortalCrossings::for_edge(scene(), x.path, edge, [&](const Portals::Point&) { ++n; });
    return n;
}

double PortalLens::suitability(const PssState& x) const {
    if (!(EyePerturbation::suitability(x) > 0)) return 0;
    const int b = structure(x).end;
    return b < x.path.k && PortalCrossings::far_end_moves(x.path, b) && count(x, b) > 0 ? 1 : 0;
}

double PortalLens::log_jacobian(const PssState& x, int edge, const Portals::Point& c) const {
    const Vertex &from = at(x, edge), &to = at(x, edge + 1);
    const Vec3 d = direction(from, to);
    const double per_area = std::abs(scene().portals().faces()[c.face].n.dot(d)) / (c.p - from.x.p).squaredNorm();
    return std::log(per_area / to_measure(from, to, d));
}

Proposal PortalLens::propose(PssState& x, PssState& y, Rng& rng) const {
    const Structure before = structure(x);
    const int b = before.end, n = count(x, b), k = x.path.k;
    Portals::Point from{};
    int left = static_cast<int>(rng.below(static_cast<std::uint64_t>(n)));
    PortalCrossings::for_edge(scene(), x.path, b, [&](const Portals::Point& c) {
        if (left-- == 0) from = c;
    });
    const auto to = point_(scene().portals(), from, rng);
    if (!to) return Proposal::failed(Failure::outside_support);
    keep(x, y);
    if (const Failure failure = walk(x, y, b, rng); failure != Failure::none) return Proposal::failed(failure);
    Vertex* const v = y.path.room.data() + b;
    const Extension e = trace_from(tracer(), v[0], (to->p - v[0].x.p).normalized(), v[1]);
    const bool last = b + 1 == k;
    if (last ? !v[1].x.emitter : e != Extension::surface || !connectable(v[1]))
        return Proposal::failed(Failure::light_subpath_short);
    if (const PathFailure failure = charts_.complete(y); failure != PathFailure::none)
        return Proposal::failed(to_failure(failure));
    bool passes = false;
    PortalCrossings::for_edge(scene(), y.path, b,
                              [&](const Portals::Point& c) { passes = passes || c.face == to->face; });
    if (!passes) return Proposal::failed(Failure::occluded);
    if (!same_structure(x, y, before) || !PortalCrossings::far_end_moves(y.path, b))
        return Proposal::failed(Failure::outside_support);
    if (!last && !visible(tracer(), v[1], v[2])) return Proposal::failed(Failure::occluded);
    Densities densities = walked(x, y, b);
    densities.forth -= log_jacobian(y, b, *to) + std::log(n);
    densities.back -= log_jacobian(x, b, from) + std::log(count(y, b));
    return proposal(x, y, densities.forth, densities.back);
}

}  // namespace keyhole
