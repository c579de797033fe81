// Malformed scenes: each ends with an InputError at the place of the mistake that says what was found and what would
// have been valid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/malformed_scenes.h"
#include "scene/scene_text.h"

namespace keyhole {
namespace {

using test::MalformedScene;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

class Malformed : public testing::TestWithParam<MalformedScene> {
  protected:
    Malformed() {
        test::write_malformed_parts(folder_.path());
        file_ = folder_.write("scene.xml", GetParam().text);
    }

    void expect_refused(const ReaderOptions& options) const {
        try {
            read_scene(file_, options);
            FAIL() << "it was read";
        } catch (const InputError& e) {
            const std::string message = e.what(), place = GetParam().place(file_);
            EXPECT_EQ(message.substr(0, place.size()), place) << message;
            EXPECT_THAT(message, HasSubstr(GetParam().message));
        }
    }

    test::Folder folder_;
    std::string file_;
};

TEST_P(Malformed, SceneIsRefused) { expect_refused({}); }

TEST_P(Malformed, SceneIsForgivenAnUnknownParameterAndNothingElse) {
    ReaderOptions options;
    options.lenient = true;
    if (!GetParam().unknown_parameter) return expect_refused(options);
    EXPECT_THAT(read_scene(file_, options).warnings,
                Contains(AllOf(StartsWith(GetParam().place(file_)), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(All, Malformed, testing::ValuesIn(test::malformed_scenes()),
                         [](const auto& test) { return test.param.name; });

TEST(MissingScene, IsRefused) {
    try {
        read_scene("/nowhere/at all.xml");
        FAIL() << "it was read";
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(), "'/nowhere/at all.xml' does not exist");
    }
}

}  // namespace
}  // namespace keyhole
