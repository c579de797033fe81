// The project's own scenes, small enough for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "scene/reader.h"

namespace keyhole {

inline const std::filesystem::path own_scenes_folder = std::filesystem::path(KEYHOLE_SOURCE_DIR) / "scenes";

// All of them, in the order of the alphabet.
inline std::vector<std::string> own_scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(own_scenes_folder))
        if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

// A scene's name as part of a test's.
inline std::string test_name_of(std::string scene) {
    std::replace(scene.begin(), scene.end(), '-', '_');
    return scene;
}

// Reads scenes/NAME.xml at the given film size.
inline std::unique_ptr<Scene> own_scene(const std::string& name, int width = 16, int height = 16,
                                        std::map<std::string, std::string> defines = {}) {
    ReaderOptions options;
    options.width = width;
    options.height = height;
    options.defines = std::move(defines);
    return read_scene((own_scenes_folder / (name + ".xml")).string(), options).scene;
}

// A scene as transport is tested in it: with wider openings than it has by itself, so that path tracing converges as
// well.
struct TransportCase {
    std::string scene;
    std::map<std::string, std::string> defines = {};
    int max_length = 5;
};

inline void PrintTo(const TransportCase& c, std::ostream* out) { *out << c.scene; }

// Every own scene is in the list (a test sees to it), and together they hold every plugin of the reader (another does).
inline const std::vector<TransportCase>& transport_cases() {
    static const std::vector<TransportCase> cases = {
        {"cornell-box"},
        {"three-planes", {{"hole", "0.1"}}},
        {"four-holes"},
        {"keyhole-room", {{"hole", "0.4"}}},
        {"ajar-door", {{"door", "60"}}},
        {"box-in-the-sun", {{"hole", "0.3"}}},
        {"blinds", {{"tilt", "30"}}},
        {"glossy-room"},
        {"glass-caustic", {{"light", "0.5"}}},
        {"charted-toy", {{"hole", "0.1"}}},
        {"stage"},
        {"gallery"},
        {"veil"},
        {"tree"},
        {"tree-reflector"},
    };
    return cases;
}

// For the names of tests over transport_cases().
inline std::string test_name_of_case(const testing::TestParamInfo<TransportCase>& test) {
    return test_name_of(test.param.scene);
}

inline std::unique_ptr<Scene> own_scene(const TransportCase& c, int width, int height) {
    return own_scene(c.scene, width, height, c.defines);
}

}  // namespace keyhole
