#include "render/passage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/frame.h"

namespace keyhole {
namespace {

// Where an edge meets a plane; empty beyond its ends.
std::optional<Vec3> meet(const NarrowEdge& edge, const Vec3& point, const Vec3& n) {
    const Vec3 d = edge.to - edge.from;
    const double t = n.dot(point - edge.from) / n.dot(d);
    return t > 0 && t < 1 ? std::optional<Vec3>(edge.from + t * d) : std::nullopt;
}

// The range of values, without one in fifty at either end, as there are always strays; longer again by their share.
std::pair<double, double> ends(std::vector<double>& values) {
    constexpr double trimmed = 0.02;
    const auto skip = static_cast<std::ptrdiff_t>(trimmed * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + skip, values.end());
    const double low = values[static_cast<std::size_t>(skip)];
    std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
    const double high = values[values.size() - 1 - static_cast<std::size_t>(skip)];
    const double more = (high - low) * trimmed / (1 - 2 * trimmed);
    return {low - more, high + more};
}

// The rectangle of the least area about points of a plane, among `directions` of its sides.
PortalFace smallest_rectangle(const Vec3& centre, const Vec3& normal, const std::vector<Vec3>& points, int directions) {
    PortalFace best;
    const Frame frame = Frame::from_normal(normal);
    double least = std::numeric_limits<double>::infinity();
    std::vector<double> a(points.size()), b(points.size());
    for (int i = 0; i < directions; ++i) {
        const double phi = 0.5 * pi * i / directions;
        const Vec3 s = std::cos(phi) * frame.s + std::sin(phi) * frame.t, t = normal.cross(s);
        for (std::size_t j = 0; j < points.size(); ++j) {
            a[j] = s.dot(points[j] - centre);
            b[j] = t.dot(points[j] - centre);
        }
        const auto [a0, a1] = ends(a);
        const auto [b0, b1] = ends(b);
        const double area = (a1 - a0) * (b1 - b0);
        if (!(area < least)) continue;
        least = area;
        best = parallelogram(centre + a0 * s + b0 * t, (a1 - a0) * s, (b1 - b0) * t);
    }
    return best;
}

// Around where edges pass a plane near a point; empty if fewer than nine of ten do.
std::optional<PortalFace> passage(const std::vector<const NarrowEdge*>& edges, const Vec3& about, const Vec3& point,
                                  const Vec3& normal, double radius, int directions) {
    std::vector<Vec3> crossings;
    for (const NarrowEdge* e : edges)
        if (const auto c = meet(*e, point, normal); c && (*c - about).norm() <= radius) crossings.push_back(*c);
    if (crossings.size() < 20 || 10 * crossings.size() < 9 * edges.size()) return std::nullopt;
    const PortalFace face = smallest_rectangle(point, normal, crossings, directions);
    return face.area > 0 ? std::optional(face) : std::nullopt;
}

// How the points that bound edges spread.
struct Spread {
    Vec3 centre = Vec3::Zero();
    Eigen::Matrix3d axes;  // columns, of the least spread first
    Vec3 widths;           // standard deviations

    explicit Spread(const std::vector<const NarrowEdge*>& edges) {
        const auto n = static_cast<double>(edges.size());
        for (const NarrowEdge* e : edges) centre += e->bound / n;
        Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
        for (const NarrowEdge* e : edges) moments += (e->bound - centre) * (e->bound - centre).transpose() / n;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
        axes = solver.eigenvectors();
        widths = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    }
};

// The plane that most of these points lie in.
Spread own_plane(std::vector<const NarrowEdge*> edges) {
    Spread spread(edges);
    for (int round = 0; round < 3; ++round) {
        std::vector<const NarrowEdge*> near;
        for (const NarrowEdge* e : edges)
            if (std::abs(spread.axes.col(0).dot(e->bound - spread.centre)) <= spread.widths[1]) near.push_back(e);
        if (near.size() < 20) break;
        edges = std::move(near);
        spread = Spread(edges);
    }
    return spread;
}

}  // namespace

bool passes(const NarrowEdge& edge, const PortalFace& face) {
    return face.crossing(edge.from, edge.to - edge.from, 1).has_value();
}

std::optional<PortalFace> narrowest_passage(const std::vector<const NarrowEdge*>& edges, const Vec3& about,
                                            double radius) {
    constexpr int coarse = 24, fine = 180;  // directions
    constexpr double clearly = 1.5;
    if (edges.size() < 20) return std::nullopt;
    const Spread plane = own_plane(edges), spread(edges);
    const auto own = passage(edges, about, plane.centre, plane.axes.col(0).normalized(), radius, fine);
    std::optional<PortalFace> best;
    Vec3 best_point, best_normal;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 point = spread.centre, normal = spread.axes.col(axis).normalized();
        auto face = passage(edges, about, point, normal, radius, coarse);
        for (double turn = 0.3, move = 0.3; face && turn > 2e-3; turn *= 0.5, move *= 0.5) {
            const Frame frame = Frame::from_normal(normal);
            const double size = std::sqrt(face->area);
            for (int i = 0; i < 6; ++i) {
                const double sign = i % 2 == 0 ? 1 : -1;
                const Vec3 tried_normal =
                    i < 4 ? Vec3((normal + sign * turn * (i < 2 ? frame.s : frame.t)).normalized()) : normal;
                const Vec3 tried_point = i < 4 ? point : Vec3(point + sign * move * size * normal);
                const auto tried = passage(edges, about, tried_point, tried_normal, radius, coarse);
                if (!tried || !(tried->area < face->area)) continue;
                face = tried;
                point = tried_point;
                normal = tried_normal;
            }
        }
        if (!face || (best && !(face->area < best->area))) continue;
        best = face;
        best_point = point;
        best_normal = normal;
    }
    if (!best || (own && own->area < clearly * best->area)) return own;
    return passage(edges, about, best_point, best_normal, radius, fine);
}

}  // namespace keyhole
