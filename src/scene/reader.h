// Reads Mitsuba scene files, the 0.5/0.6 dialect (camelCase) and the 3.x dialect (snake_case).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace keyhole {

struct ReaderOptions {
    std::map<std::string, std::string> defines;  // -D name=value
    bool lenient = false;                        // unknown parameters are warnings
    bool robust = false;                         // watertight but slower ray queries
    int width = 0, height = 0;                   // > 0: replaces the film's size
    std::string portals;                         // a scene file that holds portals alone, added to this one
    bool override_crop = false;
    int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;  // in pixels, with override_crop
    std::optional<ReconstructionFilter> filter;                   // replaces the film's
};

struct LoadedScene {
    std::unique_ptr<Scene> scene;
    std::vector<std::string> warnings;
    std::vector<std::string> unused;  // definitions that nothing refers to, parameters that have no effect here
    double seconds_reading = 0, seconds_building = 0;
};

// Throws InputError ("file:line:column: what was found; valid names: ...").
LoadedScene read_scene(const std::string& filename, const ReaderOptions& options = {});

}  // namespace keyhole
