// The project's own scenes, small enough for tests.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
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

}  // namespace keyhole
