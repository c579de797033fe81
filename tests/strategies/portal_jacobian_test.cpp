// The portal perturbation's change of variables against finite differences.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "own_scenes.h"
#include "pathspace/neighbours.h"
#include "strategies/portal.h"

namespace keyhole {
namespace {

// The point on the portal and the direction there move both ends of the edge; in area measures and solid angle the
// determinant is that of PortalPerturbation::log_jacobian, |dA_c dsigma / (dA_p dA_{p+1})|; of environment light, with
// its direction in place of the second area.
class PortalJacobian : public testing::TestWithParam<const char*> {};

TEST_P(PortalJacobian, IsThatOfFiniteDifferences) {
    const auto scene = own_scene(GetParam(), 16, 16, {{"hole", "0.3"}});
    const CoordinateLayout layout(*scene, 3);
    ChartEvaluator charts(*scene, layout, {}, {.path = true, .forgets = true, .measure = true});
    const TechniqueDistribution techniques(2, 3);
    const LargeStep large(charts, techniques);
    const PortalPerturbation portal(charts, PortalCrossings::Edges::any, {}, {0.1, 0.5});
    const PortalCrossings crossings(*scene, PortalCrossings::Edges::any);
    PssState x = charts.make_state();
    Rng rng(5, 1);
    int checked = 0, infinite = 0;
    for (int i = 0; i < 2000000 && checked < 200; ++i) {
        large.draw(x, rng);
        if (!(x.target > 0)) continue;
        const int n = crossings.count(x.path);
        if (n == 0) continue;
        const PortalCrossing c = crossings.choose(x.path, n, rng);
        const auto at = static_cast<std::size_t>(c.edge);
        const Vertex &from = x.path.room[at], &to = x.path.room[at + 1];
        const Vec3 d = direction(from, to);
        const Frame on_portal = Frame::from_normal(scene->portals().faces()[c.point.face].n);
        const Frame about = Frame::from_normal(d), at_from = Frame::from_normal(from.x.ng);
        const Frame at_to = Frame::from_normal(to.infinite ? to.x.p : to.x.ng);
        // Where the ends go: two coordinates each, in their tangent planes.
        bool same = true;
        const auto ends = [&](const Eigen::Vector4d& v) {
            const Vec3 p = c.point.p + v[0] * on_portal.s + v[1] * on_portal.t;
            const Vec3 w = (d + v[2] * about.s + v[3] * about.t).normalized();
            Vertex back, forth;
            trace_from(charts.tracer(), free_vertex(p), -w, back);
            trace_from(charts.tracer(), free_vertex(p), w, forth);
            same = same && back.x.bsdf == from.x.bsdf && forth.infinite == to.infinite &&
                   (back.x.ng - from.x.ng).norm() < 1e-9 && (forth.x.ng - to.x.ng).norm() < 1e-9;
            const Vec3 a = back.x.p - from.x.p, b = forth.x.p - to.x.p;
            return Eigen::Vector4d(a.dot(at_from.s), a.dot(at_from.t), b.dot(at_to.s), b.dot(at_to.t));
        };
        const double h = 1e-6;
        Eigen::Matrix4d m;
        for (int j = 0; j < 4; ++j)
            m.col(j) = (ends(h * Eigen::Vector4d::Unit(j)) - ends(-h * Eigen::Vector4d::Unit(j))) / (2 * h);
        if (!same) continue;  // across an edge of the scene, or on a curved surface
        ++checked;
        infinite += to.infinite;
        EXPECT_NEAR(portal.log_jacobian(x, c.edge, c.point.face), -std::log(std::abs(m.determinant())), 1e-4);
    }
    EXPECT_EQ(checked, 200);
    EXPECT_GT(infinite, std::string(GetParam()) == "box-in-the-sun" ? 20 : -1);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, PortalJacobian, testing::Values("three-planes", "box-in-the-sun"),
                         [](const auto& scene) { return test_name_of(scene.param); });

}  // namespace
}  // namespace keyhole
