// Empty cones about edges, against brute force.
#include "pathspace/triangle_angle.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/warp.h"
#include "own_scenes.h"
#include "pathspace/direction_kernel.h"
#include "scene/portals.h"

namespace keyhole {
namespace {

using Triangle = BoxHierarchy::Triangle;

Vec3 random_point(Rng& rng) {
    const double x = rng.uniform(), y = rng.uniform();
    return 2 * Vec3(x, y, rng.uniform()) - Vec3::Ones();
}

Vec3 random_direction(Rng& rng) {
    const double u = rng.uniform();
    return square_to_sphere({u, rng.uniform()});
}

ConeEdge edge_between(const Vec3& a, const Vec3& b, const Vec3& normal) {
    return {a, (b - a).normalized(), (b - a).norm(), normal};
}

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const Triangle& t) {
    return std::atan(least_tangent(ConeSlab(edge, settings), edge.apex, t));
}

// By points of the triangle: from above, and close where there are many.
double angle_by_points(const ConeEdge& edge, const ConeSettings& settings, const Triangle& t, int n) {
    double least = std::numeric_limits<double>::infinity();
    const Vec3 normal = edge.far_normal.dot(edge.axis) < 0 ? Vec3(-edge.far_normal) : edge.far_normal;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n - i; ++j) {
            const Vec3 p = t[0] + (t[1] - t[0]) * (i / double(n)) + (t[2] - t[0]) * (j / double(n)) - edge.apex;
            if (p.dot(edge.axis) < settings.t1 * edge.length) continue;
            if (normal.dot(p - settings.t2 * edge.length * edge.axis) > 0) continue;
            least = std::min(least, angle_between(edge.axis, p.normalized()));
        }
    return least;
}

TEST(Cone, LeastAngleOfATriangleIsThatOfItsPoints) {
    Rng rng(1, 1);
    const ConeSettings settings;
    int seen = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 centre = random_point(rng);
        const Triangle t = {centre + 0.5 * random_point(rng), centre + 0.5 * random_point(rng),
                            centre + 0.5 * random_point(rng)};
        const ConeEdge edge = edge_between(random_point(rng), random_point(rng), random_direction(rng));
        const double points = angle_by_points(edge, settings, t, 300), exact = least_angle(edge, settings, t);
        // Where the axis meets the triangle, the outline does not see it.
        if (triangle(t[0], t[1], t[2]).crossing(edge.apex, edge.axis, 1e9)) continue;
        ASSERT_LE(exact, points + 1e-9);
        if (points < 1) {
            ++seen;
            ASSERT_GE(exact, points - 0.03);
        }
    }
    EXPECT_GT(seen, 50);
}

struct Angles {
    double fast, cut, exact, brute;
};

Angles all_estimators(const BoxHierarchy& boxes, const ConeEdge& edge) {
    const auto with = [&](ConeEstimator estimator) {
        ConeSettings settings;
        settings.estimator = estimator;
        return ConeFinder(boxes, settings)(edge);
    };
    const ConeSettings settings;
    double brute = std::numeric_limits<double>::infinity();
    for (const Triangle& t : boxes.triangles()) brute = std::min(brute, least_angle(edge, settings, t));
    return {with(ConeEstimator::fast), with(ConeEstimator::bvh_cut), with(ConeEstimator::exact),
            std::clamp(brute, settings.tau_min, settings.tau_max)};
}

// `exact` is the smallest angle of all triangles, `bvh-cut` never above it, `fast` within the bounds: in triangle soups
// along the axes and rotated, for short and long edges.
TEST(Cone, EstimatorsAgainstBruteForce) {
    Rng rng(1, 3);
    int bound = 0;
    for (int scene = 0; scene < 40; ++scene) {
        const Eigen::AngleAxisd rotation(scene % 2 == 0 ? 0 : 0.7, Vec3(1, 2, 3).normalized());
        std::vector<Triangle> triangles;
        for (int i = 0; i < 60; ++i) {
            const Vec3 a = random_point(rng), b = a + 0.2 * random_point(rng);
            const Vec3 c = i % 3 == 0 ? Vec3(a.x(), b.y(), a.z()) : Vec3(a + 0.2 * random_point(rng));
            triangles.push_back({rotation * a, rotation * b, rotation * c});
        }
        const BoxHierarchy boxes(triangles);
        for (int i = 0; i < 50; ++i) {
            const double scale = i % 5 == 0 ? 1e-3 : i % 5 == 1 ? 100 : 1;
            const Vec3 a = random_point(rng);
            const ConeEdge edge = edge_between(a, a + scale * random_point(rng), random_direction(rng));
            const Angles angles = all_estimators(boxes, edge);
            ASSERT_DOUBLE_EQ(angles.exact, angles.brute);
            ASSERT_LE(angles.cut, angles.exact * (1 + 1e-12));
            for (const double angle : {angles.fast, angles.cut, angles.exact}) {
                ASSERT_GE(angle, 0.01);
                ASSERT_LE(angle, 0.5);
            }
            bound += angles.exact > 0.01 && angles.exact < 0.5;
        }
    }
    EXPECT_GT(bound, 200);
}

TEST(Cone, OfAnEmptySceneAndOfGrazingEdges) {
    ConeSettings settings;
    EXPECT_EQ(
        ConeFinder(BoxHierarchy(std::vector<Triangle>{}), settings)(edge_between({0, 0, 0}, {1, 0, 0}, {1, 0, 0})),
        settings.tau_max);
    // A floor that the edge runs along, 1 mm above, and ends on.
    const BoxHierarchy floor(
        {{Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(9, 9, 0)}, {Vec3(-9, -9, 0), Vec3(9, 9, 0), Vec3(-9, 9, 0)}});
    for (const auto estimator : {ConeEstimator::fast, ConeEstimator::bvh_cut, ConeEstimator::exact}) {
        settings.estimator = estimator;
        const double angle = ConeFinder(floor, settings)(edge_between({0, 0, 1e-3}, {1, 0, 0}, {0, 0, 1}));
        EXPECT_GE(angle, settings.tau_min);
        EXPECT_LE(angle, settings.tau_max);
    }
}

template <class Body>
void for_each_box(const BoxHierarchy::Node& node, const Body& body) {
    for (int lane = 0; lane < lanes; ++lane)
        if (node.boxes >> lane & 1) body(lane);
}

// Every instance and every shape that has no triangles of its own counts.
TEST(BoxHierarchy, HoldsEverythingThatRaysSee) {
    Rng rng(1, 4);
    for (const std::string& name : own_scene_names()) {
        const auto scene = own_scene(name);
        const BoxHierarchy& boxes = scene->boxes();
        ASSERT_GE(boxes.triangles().size(), scene->statistics().triangles);
        Eigen::AlignedBox3d whole;
        for_each_box(boxes.root(), [&](int lane) { whole.extend(boxes.root().box(lane)); });
        for (int i = 0; i < 2000; ++i) {
            SurfacePoint x;
            const Vec3 o = scene->center() + 0.3 * scene->radius() * random_point(rng), d = random_direction(rng);
            if (!scene->intersect({o, d}, x)) continue;
            ASSERT_LE(whole.exteriorDistance(x.p), 1e-4 * scene->radius()) << name;
        }
        // Leaves hold their triangles, and inner boxes their children.
        std::vector<const BoxHierarchy::Node*> stack = {&boxes.root()};
        std::size_t leaves = 0;
        while (!stack.empty()) {
            const BoxHierarchy::Node& node = *stack.back();
            stack.pop_back();
            for_each_box(node, [&](int lane) {
                const Eigen::AlignedBox3d box = node.box(lane);
                if (node.leaf(lane)) {
                    ++leaves;
                    for (const Vec3& p : boxes.triangle(node, lane)) ASSERT_TRUE(box.contains(p));
                    return;
                }
                const BoxHierarchy::Node& child = boxes.child(node, lane);
                for_each_box(child, [&](int i) { ASSERT_TRUE(box.contains(child.box(i))); });
                stack.push_back(&child);
            });
        }
        EXPECT_EQ(leaves, boxes.triangles().size());
    }
}

}  // namespace
}  // namespace keyhole
