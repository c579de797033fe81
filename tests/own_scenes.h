// The project's own scenes, small enough for tests.
#pragma once

#include <map>
#include <string>

#include "scene/reader.h"

namespace keyhole {

// Reads scenes/NAME.xml at the given film size.
inline std::unique_ptr<Scene> own_scene(const std::string& name, int width = 16, int height = 16,
                                        std::map<std::string, std::string> defines = {}) {
    ReaderOptions options;
    options.width = width;
    options.height = height;
    options.defines = std::move(defines);
    return read_scene(std::string(KEYHOLE_SOURCE_DIR) + "/scenes/" + name + ".xml", options).scene;
}

}  // namespace keyhole
