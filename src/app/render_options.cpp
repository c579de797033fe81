#include "app/render_options.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "base/units.h"

namespace keyhole {
namespace {

constexpr double default_mutations_per_pixel = 64;

constexpr const char* length_group = "Length of the run";
constexpr const char* path_group = "Paths";
constexpr const char* output_group = "Output";
constexpr const char* chain_group = "Markov chains (with --integrator mmlt only)";

constexpr const char* examples = R"(Examples:
  keyhole render scenes/cornell-box.xml
      64 mutations per pixel; writes cornell-box.exr and cornell-box.json here
  keyhole render room.xml -o room.exr -o room.png --time 10m --preview-every 30s
      Ten minutes; room.exr and room.png can be opened at any time
  keyhole render room.xml -o crop.exr --size 1280x720 --crop 600,300,128,128 -n 1000
      A small window of a large picture, a thousand mutations for each of its pixels
  keyhole render room.xml -o ref.exr --integrator bdpt --samples-per-pixel 4096
      A picture without Markov chains, to compare with

  keyhole render room.xml --mix mmlt-gaussian --set small-step.sigma=0.02
      Another mix of strategies, and one of its parameters (see keyhole mixes)
  keyhole render --like room.exr -o again.exr
      The same picture again, with the mutations that room.exr says it took

Ctrl-C (also SIGTERM, SIGHUP) finishes the current pass and writes the image so
far; the second quits at once. Files appear under their names only when they are
complete.

Exit codes: 0 done; 1 failure while running; 2 options or scene not valid
(nothing is written); 130, 143, 129 ended by Ctrl-C, SIGTERM, SIGHUP.)";

void add_output_options(CLI::App& command, RenderOptions& options) {
    const auto output = [&options](const std::string& text) { options.outputs.push_back(text); };
    add_parsed(command, "-o,--output", "FILE", output,
               "Image to write, .exr (32-bit float) or .png (8-bit sRGB); repeatable. A report with .json goes beside "
               "the first [default: the scene's name with .exr, in the current folder]")
        ->take_all()
        ->group(output_group);
    add_real(command, "--exposure", options.exposure, -64, 64, "Brightness of PNG images in stops [default: 0]")
        ->group(output_group);
    const auto error_image = [&options](const std::string& text) { options.error_image = text; };
    add_parsed(
        command, "--error-image", "FILE", error_image,
        "Standard error of each value of the image (.exr), by independent replicates of the run; with mmlt only. "
        "Takes 16 more images of 24 bytes per pixel of memory (where chains keep their length, 16 for each length)")
        ->group(output_group);
    const auto preview = [&options](const std::string& text) { options.settings.preview_every = parse_duration(text); };
    add_parsed(command, "--preview-every", "TIME", preview, "Write the images so far at this interval [default: never]")
        ->group(output_group);
    CLI::Option* quiet = command.add_flag("-q,--quiet", options.quiet, "Say nothing but warnings and errors");
    CLI::Option* verbose =
        command.add_flag("-v,--verbose", options.verbose, "Say more: scene, strategies, what is unused");
    quiet->group(output_group);
    verbose->group(output_group)->excludes(quiet);
}

void add_length_options(CLI::App& command, RenderSettings& settings, MixOptions& mix) {
    const auto time = [&settings](const std::string& text) {
        settings.seconds = parse_duration(text);
        if (settings.seconds <= 0) throw InputError({}, "'" + text + "' is not above zero");
    };
    add_parsed(command, "-t,--time", "TIME", time, "How long to render, such as 60s, 10m or 1h30m")
        ->group(length_group);
    add_real(command, "-n,--samples-per-pixel,--mutations-per-pixel", settings.mutations_per_pixel, 0, 1e12,
             "How many mutations (mmlt) or samples (path, bdpt) for each pixel of the crop window; such a run can be "
             "repeated bit for bit [default: 64]",
             true)
        ->group(length_group);
    add_mix_key(command, mix, "--seed", "seed", "Another seed gives another independent image [default: 0]")
        ->group(length_group);
    add_integer(command, "--threads", settings.threads, 0, 4096, "Number of threads; 0: all [default: 0]")
        ->group(length_group);
}

void add_path_options(CLI::App& command, RenderOptions& options) {
    const auto integrator = [&options](std::size_t i) {
        options.settings.integrator = std::array{Integrator::mmlt, Integrator::bdpt, Integrator::path}[i];
    };
    add_choice(command, "-i,--integrator", {"mmlt", "bdpt", "path"}, integrator,
               "mmlt: Metropolis light transport, as --mix says; or bidirectional path tracing, or path tracing "
               "[default: mmlt]")
        ->group(path_group);
    add_mix_key(command, options.mix, "--max-length", "lengths.max",
                "Most edges of a path: 1 sees lights, 2 adds direct light [default: the scene file's, else 12]")
        ->group(path_group);
    add_mix_key(command, options.mix, "--min-length", "lengths.min", "Fewest edges of a path [default: 1]")
        ->group(path_group);
}

void add_chain_options(CLI::App& command, MixOptions& mix) {
    std::vector<CLI::Option*> options = add_mix_options(command, mix, "auto, which finds one for the scene");
    options.push_back(add_mix_key(command, mix, "--chains", "chains.count", "Number of chains, or auto"));
    options.push_back(add_mix_key(command, mix, "--bootstrap", "bootstrap.samples",
                                  "Independent samples to start the chains from, or auto"));
    for (CLI::Option* option : options) option->group(chain_group);
}

// Options that were given but cannot change anything.
void refuse_without_effect(const CLI::App& command, const RenderOptions& options) {
    if (options.settings.integrator == Integrator::mmlt) return;
    const std::string why = " has no effect here; it needs --integrator mmlt";
    for (const Setting& s : options.mix.settings)
        if (s.key != "seed" && s.key != "lengths.min" && s.key != "lengths.max")
            throw InputError({}, (s.origin == "--set" ? "--set " + s.key : s.origin) + why);
    for (const char* option : {"--mix", "--error-image"})
        if (command.count(option) > 0) throw InputError({}, option + why);
}

// Starts from the run of --like in place of the defaults.
void take_stored_run(const CLI::App& command, RenderOptions& options) {
    options.stored = read_stored_run(options.like);
    options.scene = merge(options.stored->scene, options.scene);
    const RenderSettings given = options.settings;
    RenderSettings& settings = options.settings = options.stored->settings;
    if (command.count("--integrator") > 0) settings.integrator = given.integrator;
    settings.threads = given.threads;
    settings.preview_every = given.preview_every;
    if (given.seconds > 0 || given.mutations_per_pixel > 0) {
        settings.seconds = given.seconds;
        settings.mutations_per_pixel = given.mutations_per_pixel;
    }
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
    add_scene_options(command, options.scene);
    command.get_option("SCENE")->required(false);  // with --like
    const auto like = [&options](const std::string& text) { options.like = text; };
    add_parsed(
        command, "--like", "FILE", like,
        "Make the image of this .exr, .png or .json again, with the scene, mix, seed and number of mutations that "
        "it says; other options change that");
    add_output_options(command, options);
    add_length_options(command, options.settings, options.mix);
    add_path_options(command, options);
    add_chain_options(command, options.mix);
    command.footer(examples);
}

void complete_render_options(const CLI::App& command, RenderOptions& options) {
    RenderSettings& settings = options.settings;
    if (settings.seconds > 0 && settings.mutations_per_pixel > 0)
        throw InputError({}, "--time and --mutations-per-pixel exclude each other");
    if (!options.like.empty()) {
        if (options.outputs.empty()) throw InputError({}, "--like needs -o, so that no image is replaced unasked");
        take_stored_run(command, options);
    }
    if (options.scene.filename.empty()) throw InputError({}, "SCENE is required (or --like)");
    refuse_without_effect(command, options);
    settings.error_image = !options.error_image.empty();
    const bool chooses = options.like.empty() && settings.integrator == Integrator::mmlt;
    settings.mix = options.mix.apply(chooses ? builtin_mix("auto") : settings.mix);
    const bool mix_says = settings.integrator == Integrator::mmlt && settings.mix.chain_length > 0;
    if (settings.seconds == 0 && settings.mutations_per_pixel == 0 && !mix_says)
        settings.mutations_per_pixel = default_mutations_per_pixel;
}

}  // namespace keyhole
