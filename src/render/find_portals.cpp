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
    bool has_neck = false;
    std::size_t path = 0;
};

struct Sample {
    std::vector<Edge> edges;
    std::vector<double> light;  // by path: what it carries, over its density
};

void find_neck(ConeFinder& finder, Edge& edge) {
    const double length = (edge.to - edge.from).norm();
    const Vec3 d = (edge.to - edge.from) / length;
    double least = widest;
    for (const auto& [apex, axis] : {std::pair(edge.from, d), std::pair(edge.to, Vec3(-d))}) {
        const auto contact = finder.contact({apex, axis, length, axis});
        if (!contact) continue;
        const Vec3 r = *contact - apex;
        const double along = r.dot(axis), angle = std::atan2((r - along * axis).norm(), along);
        if (!(angle < least)) continue;
        least = angle;
        edge.bound = *contact;
        edge.neck = apex + along * axis;
        edge.has_neck = true;
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
    const double beyond = 2 * scene.radius();
    for (; found.tries < search.tries && found.paths < search.paths; ++found.tries) {
        if (found.tries % 4096 == 0 && stop()) break;
        large.draw(x, rng);
        if (!(x.target > 0)) continue;
        ++found.paths;
        sample.light.push_back(large.estimate(x));
        const std::span<const Vertex> v = x.path.x();
        for (int i = 0; i < x.u.k; ++i) {
            const Vertex &a = v[static_cast<std::size_t>(i)], &b = v[static_cast<std::size_t>(i) + 1];
            if (a.infinite) continue;
            Edge edge{a.x.p, b.infinite ? Vec3(a.x.p + beyond * b.x.p) : b.x.p};
            edge.path = sample.light.size() - 1;
            find_neck(finder, edge);
            sample.edges.push_back(edge);
        }
    }
    return sample;
}

bool passes(const Edge& edge, const PortalFace& face) {
    return face.crossing(edge.from, edge.to - edge.from, 1).has_value();
}

// The rectangle of the least area about points of a plane, by its direction; a few of the outermost points are left
// out on every side.
PortalFace smallest_rectangle(const Vec3& centre, const Frame& frame, const std::vector<Vec3>& points) {
    constexpr int directions = 180;
    constexpr double trimmed = 0.005;
    PortalFace best;
    double least = std::numeric_limits<double>::infinity();
    std::vector<double> a(points.size()), b(points.size());
    const auto ends = [&](std::vector<double>& values) {
        const auto skip = static_cast<std::ptrdiff_t>(trimmed * static_cast<double>(values.size()));
        std::nth_element(values.begin(), values.begin() + skip, values.end());
        const double low = values[static_cast<std::size_t>(skip)];
        std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
        return std::pair(low, values[values.size() - 1 - static_cast<std::size_t>(skip)]);
    };
    for (int i = 0; i < directions; ++i) {
        const double phi = 0.5 * pi * i / directions;
        const Vec3 s = std::cos(phi) * frame.s + std::sin(phi) * frame.t, t = frame.n.cross(s);
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

// A plane through the points that bound the bottlenecks of edges, and a rectangle around those near it. Empty if they
// lie in no plane.
std::optional<PortalFace> fit(const std::vector<const Edge*>& edges) {
    if (edges.size() < 20) return std::nullopt;
    std::vector<Vec3> points;
    for (const Edge* e : edges) points.push_back(e->bound);
    for (int round = 0;; ++round) {
        Vec3 centre = Vec3::Zero();
        for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
        Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
        for (const Vec3& p : points) moments += (p - centre) * (p - centre).transpose();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / static_cast<double>(points.size()));
        const Frame frame = Frame::from_normal(solver.eigenvectors().col(0).normalized());
        const double width = std::sqrt(solver.eigenvalues()[1]);
        if (round == 3) {
            const PortalFace face = smallest_rectangle(centre, frame, points);
            return face.area > 0 ? std::optional(face) : std::nullopt;
        }
        std::vector<Vec3> near;
        for (const Vec3& p : points)
            if (std::abs(frame.n.dot(p - centre)) <= 0.5 * width) near.push_back(p);
        if (near.size() < 20) return std::nullopt;
        points = std::move(near);
    }
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
        for (double radius = 0.5 * scene_radius; radius > 1e-4 * scene_radius; radius *= 0.7) {
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

std::optional<PortalFace> next_opening(const std::vector<const Edge*>& left, double scene_radius) {
    const auto crowd = densest(left, scene_radius);
    if (!crowd) return std::nullopt;
    std::vector<const Edge*> chosen;
    for (const Edge* e : left)
        if ((e->neck - crowd->centre).norm() <= 1.5 * crowd->radius) chosen.push_back(e);
    std::optional<PortalFace> face = fit(chosen);
    // Edges of the crowd that pass by are not of the opening.
    for (int round = 0; face && round < 3; ++round) {
        const PortalFace around = enlarged(*face, 0.3);
        const double reach = around.e1.norm() + around.e2.norm();
        chosen.clear();
        for (const Edge* e : left)
            if (passes(*e, around) && (e->neck - around.at({0.5, 0.5})).norm() <= reach) chosen.push_back(e);
        face = fit(chosen);
    }
    return face;
}

}  // namespace

FoundPortals find_portals(const Scene& scene, const PortalSearch& search, const std::function<bool()>& stop) {
    FoundPortals found;
    const Sample sample = draw_paths(scene, search, stop, found);
    const double all_light = std::accumulate(sample.light.begin(), sample.light.end(), 0.0);
    std::vector<const Edge*> left;
    for (const Edge& e : sample.edges)
        if (e.has_neck) left.push_back(&e);
    for (int tries = 0; static_cast<int>(found.portals.size()) < search.most && tries < 3 * search.most; ++tries) {
        const auto face = next_opening(left, scene.radius());
        if (!face) break;
        FoundPortal portal{*face};
        std::vector<char> through(sample.light.size(), 0);
        for (const Edge& e : sample.edges)
            if (passes(e, *face)) through[e.path] = 1;
        for (std::size_t i = 0; i < through.size(); ++i) {
            portal.share += through[i] * sample.light[i] / all_light;
            portal.paths_share += through[i] / static_cast<double>(through.size());
        }
        const PortalFace around = enlarged(*face, 0.3);
        const std::size_t before = left.size();
        std::erase_if(left, [&](const Edge* e) { return passes(*e, around); });
        if (std::max(portal.share, portal.paths_share) >= search.least_share) found.portals.push_back(portal);
        if (left.size() == before) break;
    }
    std::stable_sort(found.portals.begin(), found.portals.end(),
                     [](const FoundPortal& a, const FoundPortal& b) { return a.paths_share > b.paths_share; });
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
