#include "render/find_portals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pathspace/cone.h"
#include "pathspace/neighbours.h"
#include "render/passage.h"
#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {
namespace {

struct Sample {
    std::vector<NarrowEdge> edges;                   // of the paths that are looked at
    std::vector<std::vector<NarrowEdge>> all_edges;  // by path, without necks
    std::vector<double> light;                       // by path: what it carries, over its density
};

void find_neck(ConeFinder& finder, NarrowEdge& edge) {
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
    settings.tau_max = widest_neck;
    ConeFinder finder(scene.boxes(), settings);
    Rng rng(static_cast<std::uint64_t>(search.seed), 1);
    Sample sample;
    std::vector<std::vector<NarrowEdge>> edges;  // by path
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
            NarrowEdge edge{a.x.p, b.infinite ? Vec3(a.x.p + beyond * b.x.p) : b.x.p};
            edges.back().push_back(edge);
        }
    }
    // Each once, the bright ones for sure: those that few paths find may carry most of the light.
    constexpr double looked_at = 4000;
    const double all = std::accumulate(sample.light.begin(), sample.light.end(), 0.0);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double share = 0.5 / static_cast<double>(edges.size()) + 0.5 * sample.light[i] / all;
        if (!(rng.uniform() < looked_at * share)) continue;
        for (NarrowEdge& edge : edges[i]) {
            find_neck(finder, edge);
            sample.edges.push_back(edge);
        }
    }
    sample.all_edges = std::move(edges);
    return sample;
}

// Where necks crowd: the ball that holds most of them for its size.
struct Crowd {
    Vec3 centre;
    double radius;
};
std::optional<Crowd> densest(const std::vector<const NarrowEdge*>& edges, double scene_radius) {
    constexpr std::size_t seeds = 400;
    constexpr double growth = 0.75;  // between that of a slit in its length, 1, and none
    std::optional<Crowd> best;
    double most = 0;
    const std::size_t step = std::max<std::size_t>(1, edges.size() / seeds);
    for (std::size_t i = 0; i < edges.size(); i += step) {
        std::vector<double> distances;
        for (const NarrowEdge* e : edges) distances.push_back((e->neck - edges[i]->neck).norm());
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
double narrowed(const std::vector<const NarrowEdge*>& edges, const PortalFace& face) {
    const double size = std::sqrt(face.area), reach = face.e1.norm() + face.e2.norm();
    double passing = 0, bounded = 0;
    for (const NarrowEdge* e : edges) {
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
std::optional<Candidate> next_opening(const std::vector<const NarrowEdge*>& left,
                                      const std::vector<const NarrowEdge*>& all, double scene_radius) {
    constexpr double most_of_them = 0.5;
    const auto crowd = densest(left, scene_radius);
    if (!crowd) return std::nullopt;
    std::vector<const NarrowEdge*> chosen;
    for (const NarrowEdge* e : left)
        if ((e->neck - crowd->centre).norm() <= 1.5 * crowd->radius) chosen.push_back(e);
    Candidate candidate{*crowd, narrowest_passage(chosen, crowd->centre, 2 * crowd->radius)};
    // Edges of the crowd that pass by are not of the opening.
    for (int round = 0; candidate.face && round < 3; ++round) {
        const PortalFace around = enlarged(*candidate.face, 0.2);
        const double reach = around.e1.norm() + around.e2.norm();
        chosen.clear();
        for (const NarrowEdge* e : left)
            if (passes(*e, around) && (e->neck - around.at({0.5, 0.5})).norm() <= reach) chosen.push_back(e);
        candidate.face = narrowest_passage(chosen, around.at({0.5, 0.5}), reach);
    }
    if (candidate.face && narrowed(all, *candidate.face) < most_of_them) candidate.face.reset();
    return candidate;
}

}  // namespace

FoundPortals find_portals(const Scene& scene, const PortalSearch& search, const std::function<bool()>& stop) {
    FoundPortals found;
    const Sample sample = draw_paths(scene, search, stop, found);
    const double all_light = std::accumulate(sample.light.begin(), sample.light.end(), 0.0);
    std::vector<const NarrowEdge*> bounded;
    for (const NarrowEdge& e : sample.edges)
        if (e.angle < widest_neck) bounded.push_back(&e);
    // The narrowest first: they are openings more often than chance.
    for (const double level : {0.03, 0.06, 0.12, 0.25, widest_neck}) {
        std::vector<const NarrowEdge*> left;
        for (const NarrowEdge* e : bounded)
            if (e->angle < level) left.push_back(e);
        for (int tries = 0; static_cast<int>(found.portals.size()) < search.most && tries < 6 * search.most; ++tries) {
            const auto candidate = next_opening(left, bounded, scene.radius());
            if (!candidate) break;
            const Crowd& crowd = candidate->crowd;
            if (!candidate->face) {
                std::erase_if(
                    left, [&](const NarrowEdge* e) { return (e->neck - crowd.centre).norm() <= 0.5 * crowd.radius; });
                continue;
            }
            FoundPortal portal{*candidate->face};
            std::vector<char> through(sample.light.size(), 0);
            for (std::size_t i = 0; i < through.size(); ++i)
                through[i] = std::any_of(sample.all_edges[i].begin(), sample.all_edges[i].end(),
                                         [&](const NarrowEdge& e) { return passes(e, portal.face); });
            for (std::size_t i = 0; i < through.size(); ++i) {
                portal.share += through[i] * sample.light[i] / all_light;
                portal.paths_share += through[i] / static_cast<double>(through.size());
            }
            const PortalFace around = enlarged(portal.face, 0.3);
            const auto of_portal = [&](const NarrowEdge* e) {
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
