// `keyhole cones`
#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/options.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "render/cone_image.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
For each pixel, the half-angle (radians) of the largest empty cone about the edge
from the sensor through the pixel's centre: the largest step of geometry-aware
perturbations there. Prints how the estimate compares with the exact angle, and
what both cost.

Example: keyhole cones scenes/ajar-door.xml -o cones.exr --estimator fast

Exit codes: 0 done; 1 the image cannot be written; 2 options or scene not valid.)";

const std::vector<std::string> estimators = {"fast", "bvh-cut", "exact"};

struct ConeOptions {
    SceneOptions scene;
    ConeSettings settings;
    std::string output = "cones.exr";
};

int run(const ConeOptions& options) {
    image_format(options.output);
    check_writable(options.output);
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    const ConeImage cones = [&] {
        try {
            return cone_image(*loaded.scene, options.settings);
        } catch (const std::invalid_argument& e) {
            throw InputError({options.scene.filename}, e.what());
        }
    }();
    const std::string& name = estimators[static_cast<std::size_t>(options.settings.estimator)];
    fmt::print("{} edges; {} / exact: mean {:.4f}, farthest from 1 {:.4f}\n", cones.edges, name, cones.mean_ratio,
               cones.worst_ratio);
    fmt::print("one cone: {} {:.2f} us, exact {:.2f} us\n", name, 1e6 * cones.seconds, 1e6 * cones.seconds_exact);
    write_image(options.output, cones.angles,
                {{{"keyhole:estimator", name}, {"keyhole:scene", options.scene.filename}}});
    fmt::print("wrote {}\n", options.output);
    return exit_success;
}

}  // namespace

void add_cones_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<ConeOptions>();
    CLI::App* command = keyhole.add_subcommand("cones", "Show how much room there is about primary rays");
    add_scene_options(*command, options->scene);
    command->add_option("-o,--output", options->output, "Image, .exr or .png [default: cones.exr]")
        ->option_text("FILE");
    ConeSettings& s = options->settings;
    add_choice(
        *command, "--estimator", estimators, [&s](std::size_t i) { s.estimator = static_cast<ConeEstimator>(i); },
        "How cones are found [default: bvh-cut]");
    add_integer(*command, "--boxes", s.boxes, 0, 10000, "bvh-cut: boxes from which on none is opened [default: 10]");
    add_real(*command, "--tau-min", s.tau_min, 0, 1.5, "Smallest angle in radians [default: 0.01]", true);
    add_real(*command, "--tau-max", s.tau_max, 0, 1.5, "Largest angle in radians [default: 0.5]", true);
    command->footer(footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
