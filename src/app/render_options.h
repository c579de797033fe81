// The options of `keyhole render`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/mix_options.h"
#include "app/options.h"
#include "app/stored_run.h"
#include "render/render.h"

namespace keyhole {

struct RenderOptions {
    SceneOptions scene;
    RenderSettings settings;
    MixOptions mix;
    std::string like;                 // --like: an image or report
    std::optional<StoredRun> stored;  // what it says
    std::vector<std::string> outputs;
    double exposure = 0;      // stops
    std::string error_image;  // --error-image; empty: none
    bool quiet = false, verbose = false;

    Verbosity verbosity() const { return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal; }
};

// `options` must live until the command line has been parsed.
void add_render_options(CLI::App& command, RenderOptions& options);

// After parsing: reads the mix and the run of --like and fills in the default length. Throws InputError for options
// that contradict each other or have no effect.
void complete_render_options(const CLI::App& command, RenderOptions& options);

}  // namespace keyhole
