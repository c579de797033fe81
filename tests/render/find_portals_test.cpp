// The portals that are found are those that were made by hand.
#include "render/find_portals.h"

#include <gtest/gtest.h>

#include "own_scenes.h"

namespace keyhole {
namespace {

class FindPortals : public testing::TestWithParam<const char*> {};

// Area that both cover over the area that either does, in the plane of the one made by hand, by a grid.
double overlap(const PortalFace& made, const PortalFace& found) {
    constexpr int cells = 400;
    int both = 0, either = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const Vec2 ab = (Vec2(i + 0.5, j + 0.5) / cells) * 2 - Vec2(0.5, 0.5);
            const Vec3 p = made.at(ab);
            const bool in_made = made.holds(ab);
            const bool in_found = found.crossing(p - 1e3 * made.n, made.n, 1e9).has_value();
            both += in_made && in_found;
            either += in_made || in_found;
        }
    return either > 0 ? both / double(either) : 0;
}

TEST_P(FindPortals, FindsTheOpenings) {
    const auto scene = own_scene(GetParam(), 32, 20);
    const FoundPortals found = find_portals(*scene, {});
    ASSERT_FALSE(found.portals.empty()) << found.paths << " paths";
    for (const PortalFace& made : scene->portals().faces()) {
        const PortalFace& first = found.portals.front().face;
        const double size = std::sqrt(made.area);
        EXPECT_LT((first.at({0.5, 0.5}) - made.at({0.5, 0.5})).norm(), 0.3 * size);
        EXPECT_GT(overlap(made, first), 0.8) << first.e1.norm() << " x " << first.e2.norm();
    }
    EXPECT_GT(found.portals.front().share, 0.5);
    EXPECT_NE(portals_xml(found, "test").find("type=\"portal\""), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(OwnScenes, FindPortals,
                         testing::Values("three-planes", "keyhole-room", "box-in-the-sun", "charted-toy", "ajar-door",
                                         "blinds"),
                         [](const auto& scene) { return test_name_of(scene.param); });

}  // namespace
}  // namespace keyhole
