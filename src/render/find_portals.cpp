#include "render/find_portals.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pathspace/cone.h"
#include "pathspace/neighbours.h"
#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {
namespace {

constexpr double widest = 0.4;  // radians: half-angle of cones whose bound counts as a bottleneck

// An edge of a path; `bound` limits the empty double cone about it, and `neck` is the edge's point beside that.
struct Edge {
    Vec3 from, to;
    Vec3 neck{0, 0, 0}, bound{0, 0, 0};
    double angle = widest;  // of the cone; `widest`: nothing bounds it
};

struct Sample {
    std::vector<Edge> edges;                   // of the paths that are looked at
    std::vector<std::vector<Edge>> all_edges;  // by path, without necks
    std::vector<double> light;                 // by path: what it carries, over its density
};

void find_neck(ConeFinder& finder, Edge& edge) {
    const double length = (edge.to - edge.from).norm();
    const Vec3 d = (edge.to - edge.from) / length;
    for (const auto& [apex, axis] : {std::pair(edge.from, d), std::pair(edge.to, Vec3(-d))}) {
        const auto contact = finder.contact({apex, axis, length, axis});
        if (!contact) continue;
        const Vec3 r = *contact - apex;
        const double along = r.dot(axis), angle = std::atan2((r - along * axis).norm(), along);
        if (!(angle < edge.angle)) continue;
        edge.angle = angle;
        edge.bound = *contact;
        edge.neck = apex + along * axis;
    }
}

Sample draw_paths(const Scene& scene, const PortalSearch& search, const std::function<bool()>& stop,
                  FoundPortals& found) {
    const int of_scene = scene.max_path_length();
    const int longest = search.max_length > 0 ? search.max_length : of_scene > 0 ? of_scene : 8;
    const CoordinateLayout layout(scene, longest);
    ChartEvaluator charts(scene, layout, {}, {.path = true});
    const TechniqueDistribution techniques(1, longest);
    const LargeStep large(charts, techniques);
    PssState x = charts.make_state();
    ConeSettings settings;
    settings.t2 = 0.5;
    settings.tau_max = widest;
    ConeFinder finder(scene.boxes(), settings);
    Rng rng(static_cast<std::uint64_t>(search.seed), 1);
    Sample sample;
    std::vector<std::vector<Edge>> edges;  // by path
    const double beyond = 2 * scene.radius();
    for (; found.tries < search.tries && found.paths < search.paths; ++found.tries) {
        if (found.tries % 4096 == 0 && stop()) break;
        large.draw(x, rng);
        if (!(x.target > 0)) continue;
        ++found.paths;
        sample.light.push_back(large.estimate(x));
        const std::span<const Vertex> v = x.path.x();
        edges.emplace_back();
        for (int i = 0; i < x.u.k; ++i) {
            const Vertex &a = v[static_cast<std::size_t>(i)], &b = v[static_cast<std::size_t>(i) + 1];
            if (a.infinite) continue;
            Edge edge{a.x.p, b.infinite ? Vec3(a.x.p + beyond * b.x.p) : b.x.p};
            edges.back().push_back(edge);
        }
    }
    // Each once, the bright ones for sure: those that few paths find may carry most of the light.
    constexpr double looked_at = 4000;
    const double all = std::accumulate(sample.light.begin(), sample.light.end(), 0.0);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double share = 0.5 / static_cast<double>(edges.size()) + 0.5 * sample.light[i] / all;
        if (!(rng.uniform() < looked_at * share)) continue;
        for (Edge& edge : edges[i]) {
            find_neck(finder, edge);
            sample.edges.push_back(edge);
        }
    }
    sample.all_edges = std::move(edges);
    return sample;
}

bool passes(const Edge& edge, const PortalFace& face) {
    return face.crossing(edge.from, edge.to - edge.from, 1).has_value();
}

// Where an edge meets a plane; empty beyond its ends.
std::optional<Vec3> meet(const Edge& edge, const Vec3& point, const Vec3& n) {
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
std::optional<PortalFace> passage(const std::vector<const Edge*>& edges, const Vec3& about, const Vec3& point,
                                  const Vec3& normal, double radius, int directions) {
    std::vector<Vec3> crossings;
    for (const Edge* e : edges)
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

    explicit Spread(const std::vector<const Edge*>& edges) {
        const auto n = static_cast<double>(edges.size());
        for (const Edge* e : edges) centre += e->bound / n;
        Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
        for (const Edge* e : edges) moments += (e->bound - centre) * (e->bound - centre).transpose() / n;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
        axes = solver.eigenvectors();
        widths = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    }
};

// The plane that most of these points lie in.
Spread own_plane(std::vector<const Edge*> edges) {
    Spread spread(edges);
    for (int round = 0; round < 3; ++round) {
        std::vector<const Edge*> near;
        for (const Edge* e : edges)
            if (std::abs(spread.axes.col(0).dot(e->bound - spread.centre)) <= spread.widths[1]) near.push_back(e);
        if (near.size() < 20) break;
        edges = std::move(near);
        spread = Spread(edges);
    }
    return spread;
}

// The narrowest passage of a bundle of edges: where they pass the plane that the points that bound them lie in; or, if
// that is clearly narrower, another plane, found by turning and moving planes while the passage becomes smaller.
std::optional<PortalFace> fit(const std::vector<const Edge*>& edges, const Vec3& about, double radius) {
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

// Where necks crowd: the ball that holds most of them for its size.
struct Crowd {
    Vec3 centre;
    double radius;
};
std::optional<Crowd> densest(const std::vector<const Edge*>& edges, double scene_radius) {
    constexpr std::size_t seeds = 400;
    constexpr double growth = 0.75;  // between that of a slit in its length, 1, and none
    std::optional<Crowd> best;
    double most = 0;
    const std::size_t step = std::max<std::size_t>(1, edges.size() / seeds);
    for (std::size_t i = 0; i < edges.size(); i += step) {
        std::vector<double> distances;
        for (const Edge* e : edges) distances.push_back((e->neck - edges[i]->neck).norm());
        std::sort(distances.begin(), distances.end());
        for (double radius = 0.35 * scene_radius; radius > 1e-4 * scene_radius; radius *= 0.7) {
            const auto count = std::upper_bound(distances.begin(), distances.end(), radius) - distances.begin();
            if (count < 20) break;
            const double score = static_cast<double>(count) / std::pow(radius / scene_radius, growth);
            if (!(score > most)) continue;
            most = score;
            best = Crowd{edges[i]->neck, radius};
        }
    }
    return best;
}

PortalFace enlarged(const PortalFace& f, double by) {
    return parallelogram(f.p - 0.5 * by * (f.e1 + f.e2), (1 + by) * f.e1, (1 + by) * f.e2);
}

// Of the edges that pass a rectangle, how many have their bottleneck there: bounded near its plane and not far from it.
double narrowed(const std::vector<const Edge*>& edges, const PortalFace& face) {
    const double size = std::sqrt(face.area), reach = face.e1.norm() + face.e2.norm();
    double passing = 0, bounded = 0;
    for (const Edge* e : edges) {
        if (!passes(*e, face)) continue;
        ++passing;
        const Vec3 r = e->bound - face.at({0.5, 0.5});
        bounded += std::abs(face.n.dot(r)) <= 0.3 * size && r.norm() <= reach;
    }
    return passing > 0 ? bounded / passing : 0;
}

// Empty where nothing crowds; else whether it is an opening, and where it is.
struct Candidate {
    Crowd crowd;
    std::optional<PortalFace> face;
};
std::optional<Candidate> next_opening(const std::vector<const Edge*>& left, const std::vector<const Edge*>& all,
                                      double scene_radius) {
    constexpr double most_of_them = 0.5;
    const auto crowd = densest(left, scene_radius);
    if (!crowd) return std::nullopt;
    std::vector<const Edge*> chosen;
    for (const Edge* e : left)
        if ((e->neck - crowd->centre).norm() <= 1.5 * crowd->radius) chosen.push_back(e);
    Candidate candidate{*crowd, fit(chosen, crowd->centre, 2 * crowd->radius)};
    // Edges of the crowd that pass by are not of the opening.
    for (int round = 0; candidate.face && round < 3; ++round) {
        const PortalFace around = enlarged(*candidate.face, 0.2);
        const double reach = around.e1.norm() + around.e2.norm();
        chosen.clear();
        for (const Edge* e : left)
            if (passes(*e, around) && (e->neck - around.at({0.5, 0.5})).norm() <= reach) chosen.push_back(e);
        candidate.face = fit(chosen, around.at({0.5, 0.5}), reach);
    }
    if (candidate.face && narrowed(all, *candidate.face) < most_of_them) candidate.face.reset();
    return candidate;
}

}  // namespace

FoundPortals find_portals(const Scene& scene, const PortalSearch& search, const std::function<bool()>& stop) {
    FoundPortals found;
    const Sample sample = draw_paths(scene, search, stop, found);
    const double all_light = std::accumulate(sample.light.begin(), sample.light.end(), 0.0);
    std::vector<const Edge*> bounded;
    for (const Edge& e : sample.edges)
        if (e.angle < widest) bounded.push_back(&e);
    // The narrowest first: they are openings more often than chance.
    for (const double level : {0.03, 0.06, 0.12, 0.25, widest}) {
        std::vector<const Edge*> left;
        for (const Edge* e : bounded)
            if (e->angle < level) left.push_back(e);
        for (int tries = 0; static_cast<int>(found.portals.size()) < search.most && tries < 6 * search.most; ++tries) {
            const auto candidate = next_opening(left, bounded, scene.radius());
            if (!candidate) break;
            const Crowd& crowd = candidate->crowd;
            if (!candidate->face) {
                std::erase_if(left,
                              [&](const Edge* e) { return (e->neck - crowd.centre).norm() <= 0.5 * crowd.radius; });
                continue;
            }
            FoundPortal portal{*candidate->face};
            std::vector<char> through(sample.light.size(), 0);
            for (std::size_t i = 0; i < through.size(); ++i)
                through[i] = std::any_of(sample.all_edges[i].begin(), sample.all_edges[i].end(),
                                         [&](const Edge& e) { return passes(e, portal.face); });
            for (std::size_t i = 0; i < through.size(); ++i) {
                portal.share += through[i] * sample.light[i] / all_light;
                portal.paths_share += through[i] / static_cast<double>(through.size());
            }
            const PortalFace around = enlarged(portal.face, 0.3);
            const auto of_portal = [&](const Edge* e) {
                return passes(*e, around) || (e->neck - crowd.centre).norm() <= crowd.radius;
            };
            std::erase_if(left, of_portal);
            std::erase_if(bounded, of_portal);
            if (portal.share >= search.least_share) found.portals.push_back(portal);
        }
    }
    // One that lies within another and lets nearly as much through is the opening; the other is around it.
    const std::vector<FoundPortal> all = found.portals;
    std::erase_if(found.portals, [&](const FoundPortal& a) {
        return std::any_of(all.begin(), all.end(), [&](const FoundPortal& b) {
            const double reach = a.face.e1.norm() + a.face.e2.norm();
            return b.face.area < a.face.area && b.share > 0.85 * a.share &&
                   (b.face.at({0.5, 0.5}) - a.face.at({0.5, 0.5})).norm() < reach;
        });
    });
    std::stable_sort(found.portals.begin(), found.portals.end(),
                     [](const FoundPortal& a, const FoundPortal& b) { return a.share > b.share; });
    return found;
}

std::string portals_xml(const FoundPortals& found, const std::string& comment) {
    std::string xml = fmt::format("<!-- {} -->\n<scene version=\"3.0.0\">\n", comment);
    for (std::size_t i = 0; i < found.portals.size(); ++i) {
        const FoundPortal& p = found.portals[i];
        const Vec3 s = 0.5 * p.face.e1, t = 0.5 * p.face.e2, c = p.face.at({0.5, 0.5}), n = p.face.n;
        xml += fmt::format(
            "    <!-- {:.3g} x {:.3g}; {:.1f}% of the sampled light and {:.1f}% of its paths pass here. -->\n"
            "    <shape type=\"portal\" id=\"portal-{}\">\n        <transform name=\"to_world\">\n"
            "            <matrix value=\"",
            2 * s.norm(), 2 * t.norm(), 100 * p.share, 100 * p.paths_share, i + 1);
        for (int row = 0; row < 3; ++row)
            xml += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} ", s[row], t[row], n[row], c[row]);
        xml += "0 0 0 1\"/>\n        </transform>\n    </shape>\n";
    }
    return xml + "</scene>\n";
}

}  // namespace keyhole
