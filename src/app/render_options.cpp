#include "app/render_options.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "base/units.h"

namespace keyhole {
namespace {

constexpr double default_mutations_per_pixel = 64;
constexpr int longest_path = 256;  // of render()

constexpr const char* length_group = "Length of the run";
constexpr const char* path_group = "Paths";
constexpr const char* output_group = "Output";
constexpr const char* mmlt_group = "Markov chains (with --integrator mmlt only)";

constexpr const char* examples = R"(Examples:
  keyhole render scenes/cornell-box.xml
      64 mutations per pixel; writes cornell-box.exr and cornell-box.json here
  keyhole render room.xml -o room.exr -o room.png --time 10m --preview-every 30s
      Ten minutes; room.exr and room.png can be opened at any time
  keyhole render room.xml -o crop.exr --size 1280x720 --crop 600,300,128,128 -n 1000
      A small window of a large picture, a thousand mutations for each of its pixels
  keyhole render room.xml -o ref.exr --integrator bdpt --samples-per-pixel 4096
      A picture without Markov chains, to compare with

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
    const auto preview = [&options](const std::string& text) { options.settings.preview_every = parse_duration(text); };
    add_parsed(command, "--preview-every", "TIME", preview, "Write the images so far at this interval [default: never]")
        ->group(output_group);
    CLI::Option* quiet = command.add_flag("-q,--quiet", options.quiet, "Say nothing but warnings and errors");
    CLI::Option* verbose =
        command.add_flag("-v,--verbose", options.verbose, "Say more: scene, strategies, what is unused");
    quiet->group(output_group);
    verbose->group(output_group)->excludes(quiet);
}

void add_length_options(CLI::App& command, RenderSettings& settings) {
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
    const auto seed = [&settings](const std::string& text) { settings.seed = parse_unsigned(text); };
    add_parsed(command, "--seed", "INTEGER", seed, "Another seed gives another independent image [default: 0]")
        ->group(length_group);
    add_integer(command, "--threads", settings.threads, 0, 4096, "Number of threads; 0: all [default: 0]")
        ->group(length_group);
}

void add_path_options(CLI::App& command, RenderSettings& settings) {
    const auto integrator = [&settings](std::size_t i) {
        settings.integrator = std::array{Integrator::mmlt, Integrator::bdpt, Integrator::path}[i];
    };
    add_choice(command, "-i,--integrator", {"mmlt", "bdpt", "path"}, integrator,
               "Multiplexed Metropolis light transport, bidirectional path tracing, or path tracing [default: mmlt]")
        ->group(path_group);
    add_integer(command, "--max-length", settings.max_length, 1, longest_path,
                "Most edges of a path: 1 sees lights, 2 adds direct light [default: the scene file's, else 12]")
        ->group(path_group);
    add_integer(command, "--min-length", settings.min_length, 1, longest_path, "Fewest edges of a path [default: 1]")
        ->group(path_group);
}

void add_mmlt_options(CLI::App& command, RenderSettings& settings) {
    const auto kernel = [&settings](std::size_t i) {
        settings.kernel = i == 0 ? StepKernel::kelemen : StepKernel::gaussian;
    };
    const std::array<CLI::Option*, 8> options = {
        add_integer(command, "--chains", settings.chains, 0, 1 << 30,
                    "Number of chains; 0: chosen for the run [default: 0]"),
        add_integer(command, "--bootstrap", settings.bootstrap_samples, std::int64_t{0}, std::int64_t{1} << 40,
                    "Independent samples to start the chains from; 0: chosen for the run [default: 0]"),
        add_real(command, "--large-step", settings.large_step_probability, 0, 1,
                 "Probability of an independent proposal [default: 0.1]", true),
        add_real(command, "--technique-change", settings.technique_change_probability, 0, 1,
                 "Probability of a change of technique [default: 0.05]"),
        add_choice(command, "--kernel", {"kelemen", "gaussian"}, kernel, "Small steps [default: kelemen]"),
        add_real(command, "--kelemen-s1", settings.kelemen_s1, 0, 1, "Smallest step of kelemen [default: 1/1024]",
                 true),
        add_real(command, "--kelemen-s2", settings.kelemen_s2, 0, 1, "Largest step of kelemen [default: 1/64]", true),
        add_real(command, "--sigma", settings.gaussian_sigma, 0, 1, "Standard deviation of gaussian [default: 0.01]",
                 true)};
    for (CLI::Option* option : options) option->group(mmlt_group);
}

// Options that were given but cannot change anything.
void refuse_without_effect(const CLI::App& command, const RenderSettings& settings) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0) continue;
        const std::string name = option->get_name();
        if (settings.integrator != Integrator::mmlt && option->get_group() == mmlt_group)
            throw InputError({}, name + " has no effect here; it needs --integrator mmlt");
        if (settings.kernel == StepKernel::kelemen && name == "--sigma")
            throw InputError({}, "--sigma has no effect here; it needs --kernel gaussian");
        if (settings.kernel == StepKernel::gaussian && name.starts_with("--kelemen-"))
            throw InputError({}, name + " has no effect here; it needs --kernel kelemen");
    }
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
    add_scene_options(command, options.scene);
    add_output_options(command, options);
    add_length_options(command, options.settings);
    add_path_options(command, options.settings);
    add_mmlt_options(command, options.settings);
    command.footer(examples);
}

void complete_render_options(const CLI::App& command, RenderOptions& options) {
    RenderSettings& settings = options.settings;
    refuse_without_effect(command, settings);
    if (settings.seconds > 0 && settings.mutations_per_pixel > 0)
        throw InputError({}, "--time and --mutations-per-pixel exclude each other");
    if (settings.seconds == 0 && settings.mutations_per_pixel == 0)
        settings.mutations_per_pixel = default_mutations_per_pixel;
    if (settings.max_length > 0 && settings.max_length < settings.min_length)
        throw InputError(
            {}, fmt::format("--max-length {} is below --min-length {}", settings.max_length, settings.min_length));
    if (settings.kelemen_s1 > settings.kelemen_s2)
        throw InputError(
            {}, fmt::format("--kelemen-s1 {} is above --kelemen-s2 {}", settings.kelemen_s1, settings.kelemen_s2));
    if (settings.large_step_probability + settings.technique_change_probability > 1)
        throw InputError({}, "--large-step and --technique-change sum to more than 1");
}

}  // namespace keyhole
