// The options of `keyhole render`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/options.h"
#include "render/render.h"

namespace keyhole {

struct RenderOptions {
    SceneOptions scene;
    RenderSettings settings;
    std::vector<std::string> outputs;
    double exposure = 0;  // stops
    bool quiet = false, verbose = false;

    Verbosity verbosity() const { return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal; }
};

// `options` must live until the command line has been parsed.
void add_render_options(CLI::App& command, RenderOptions& options);

// After parsing: fills in the default length. Throws InputError for options that contradict each other or have no
// effect.
void complete_render_options(const CLI::App& command, RenderOptions& options);

}  // namespace keyhole
