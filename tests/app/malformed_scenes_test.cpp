// Every malformed scene through the command: the place, what would have been valid, exit code 2, and nothing written.
#include "scene/malformed_scenes.h"

#include <gmock/gmock.h>

#include "harness.h"

namespace keyhole {
namespace {

using test::MalformedScene;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAreArray;

class Malformed : public CommandTest, public testing::WithParamInterface<MalformedScene> {};

TEST_P(Malformed, SceneIsRefused) {
    std::vector<std::string> before = test::write_malformed_parts(folder());
    before.push_back(write("scene.xml", GetParam().text));
    const Finished done = run(quick_render("scene.xml", {"-o", "a.exr", "-o", "a.png"}));
    EXPECT_EQ(done.exit_code, 2);
    EXPECT_THAT(done.err, StartsWith("keyhole: error: " + GetParam().place("scene.xml")));
    EXPECT_THAT(done.err, HasSubstr(GetParam().message));
    EXPECT_EQ(done.out, "");
    EXPECT_THAT(files(), UnorderedElementsAreArray(before));
}

INSTANTIATE_TEST_SUITE_P(All, Malformed, testing::ValuesIn(test::malformed_scenes()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace keyhole
