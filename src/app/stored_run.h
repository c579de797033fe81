// A run as an image or report of Keyhole tells it: what `keyhole render --like` makes again.
#pragma once

#include <string>

#include "app/options.h"
#include "render/render.h"

namespace keyhole {

struct StoredRun {
    std::string filename;  // that it was read from
    SceneOptions scene;
    RenderSettings settings;  // with the number of mutations (samples) that were made, not a time
    std::string scene_hash, version;
};

// `filename`: .exr, .png, or the .json beside them. Throws InputError if it does not hold a complete description.
StoredRun read_stored_run(const std::string& filename);

// `stored` with what the command line says differently.
SceneOptions merge(const SceneOptions& stored, const SceneOptions& given);

}  // namespace keyhole
