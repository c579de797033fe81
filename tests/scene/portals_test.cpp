// Portals: faces, crossings, sampling, and how scene files give them.
#include "scene/portals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "scene_text.h"
#include "statistics.h"

namespace keyhole {
namespace {

using test::Folder;
using test::scene_with;
using testing::HasSubstr;

TEST(PortalFace, MeetsLinesWithinItself) {
    const PortalFace quad = parallelogram({0, 0, 1}, {2, 0, 0}, {1, 1, 0});
    EXPECT_DOUBLE_EQ(quad.area, 2);
    EXPECT_TRUE(quad.crossing({1, 0.5, 0}, {0, 0, 1}, 2));
    EXPECT_FALSE(quad.crossing({1, 0.5, 0}, {0, 0, 1}, 0.5)) << "beyond the far end";
    EXPECT_FALSE(quad.crossing({1, 0.5, 2}, {0, 0, 1}, 9)) << "behind";
    EXPECT_FALSE(quad.crossing({0, 0.5, 0}, {0, 0, 1}, 2)) << "beside: the parallelogram is slanted";
    EXPECT_FALSE(quad.crossing({-1, 0.5, 1}, {1, 0, 0}, 9)) << "in its plane";
    EXPECT_FALSE(quad.crossing({1, 0.5, 1}, {0, 0, 1}, 9)) << "starts on it";
    const auto grazing = quad.crossing({-1e6, 0.5, 1 - 1e-3}, Vec3(1e6 + 1, 0, 1e-3).normalized(), 1e9);
    ASSERT_TRUE(grazing) << "edge-on, but for 1e-9";
    EXPECT_NEAR((quad.at(*grazing) - Vec3(1, 0.5, 1)).norm(), 0, 1e-3);
    const PortalFace corner = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_DOUBLE_EQ(corner.area, 0.5);
    EXPECT_TRUE(corner.crossing({0.2, 0.2, -1}, {0, 0, 1}, 2));
    EXPECT_FALSE(corner.crossing({0.6, 0.6, -1}, {0, 0, 1}, 2));
}

TEST(Portals, AreSampledEvenly) {
    Portals portals;
    portals.add("other", {parallelogram({5, 5, 5}, {1, 0, 0}, {0, 1, 0})});
    portals.add("two triangles and a square",
                {triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), triangle({1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                 parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0})});
    EXPECT_DOUBLE_EQ(portals.area(1), 2);
    Rng rng(3, 1);
    constexpr int samples = 40000;
    std::vector<double> expected(32, samples / 32.0), observed(32, 0);
    for (int i = 0; i < samples; ++i) {
        const double u_face = rng.uniform(), first = rng.uniform();
        const Portals::Point p = portals.sample(1, u_face, {first, rng.uniform()});
        const PortalFace& face = portals.faces()[p.face];
        EXPECT_EQ(face.portal, 1U);
        EXPECT_TRUE(face.holds(face.coordinates(p.p) * (1 - 1e-12) + Vec2::Constant(1e-13)));
        ++observed[static_cast<std::size_t>(p.p.x() * 4) * 4 + static_cast<std::size_t>(p.p.y() * 4)];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), 1e-4);
    EXPECT_THROW(portals.add("line", {triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0})}), std::invalid_argument);
}

std::unique_ptr<Scene> read(const Folder& folder, const std::string& inside, const ReaderOptions& options = {}) {
    return read_scene(folder.write("scene.xml", scene_with(inside)), options).scene;
}
std::string refusal(const Folder& folder, const std::string& inside, const ReaderOptions& options = {}) {
    try {
        read(folder, inside, options);
    } catch (const InputError& e) {
        return e.what();
    }
    return "not refused";
}

TEST(PortalReader, ReadsRectanglesAndMeshesThatRaysDoNotSee) {
    const Folder folder;
    folder.write("fan.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const auto scene = read(folder, R"(<shape type="portal" id="door"><transform name="to_world">
        <scale x="2"/><rotate y="1" angle="90"/><translate x="5"/></transform></shape>
        <shape type="portal"><string name="filename" value="fan.obj"/></shape>)");
    const Portals& portals = scene->portals();
    ASSERT_EQ(portals.names(), (std::vector<std::string>{"door", ""}));
    ASSERT_EQ(portals.faces().size(), 3U);
    EXPECT_NEAR(portals.area(0), 8, 1e-12);
    EXPECT_NEAR(portals.area(1), 1, 1e-6);
    EXPECT_NEAR(std::abs(portals.faces()[0].n.x()), 1, 1e-12);
    EXPECT_NEAR(portals.faces()[0].at({0.5, 0.5}).x(), 5, 1e-12);
    EXPECT_EQ(scene->statistics().triangles, read(folder, "")->statistics().triangles);
    EXPECT_TRUE(scene->unoccluded({{4, 0, 0}, {1, 0, 0}, 0, 2}));
}

TEST(PortalReader, TakesPortalsFromASideFile) {
    const Folder folder;
    ReaderOptions options;
    options.portals = folder.write("portals.xml", R"(<scene version="3.0.0"><shape type="portal" id="a"/></scene>)");
    EXPECT_EQ(read(folder, R"(<shape type="portal" id="b"/>)", options)->portals().names(),
              (std::vector<std::string>{"b", "a"}));
    EXPECT_NE(read(folder, "", options)->content_hash(), read(folder, "")->content_hash());
    options.portals = folder.write("other.xml", R"(<scene version="3.0.0"><shape type="sphere"/></scene>)");
    EXPECT_THAT(refusal(folder, "", options), HasSubstr("a file of portals holds <shape type=\"portal\"> alone"));
    options.portals = "nowhere.xml";
    EXPECT_THAT(refusal(folder, "", options), HasSubstr("nowhere.xml"));
}

TEST(PortalReader, RefusesWhatIsNoPortal) {
    const Folder folder;
    folder.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    EXPECT_THAT(refusal(folder, R"(<shape type="portal"><string name="filename" value="line.obj"/></shape>)"),
                HasSubstr("must have an area"));
    EXPECT_THAT(refusal(folder, R"(<shape type="portal"><bsdf type="diffuse"/></shape>)"), HasSubstr("portal"));
    EXPECT_THAT(refusal(folder, R"(<shape type="shapegroup" id="g"><shape type="portal"/></shape>)"),
                HasSubstr("not in a shapegroup"));
}

}  // namespace
}  // namespace keyhole
