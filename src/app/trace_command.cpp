// `keyhole trace`
#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/mix_options.h"
#include "app/options.h"
#include "base/atomic_file.h"
#include "render/chain_trace.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
Draws where the first chain of a render goes: in the image, coloured by the strategy
that moved it, with the proposals that were rejected, and x and y over the mutations.
A chain that mixes well covers the bright parts of the image like noise; one that is
stuck draws level lines.

Example: keyhole trace scenes/three-planes.xml --mix portal --mutations 2000

Exit codes: 0 done; 1 the file cannot be written, or no path carries light; 2 options
or scene not valid.)";

struct TraceOptions {
    SceneOptions scene;
    MixOptions mix;
    std::string output = "trace.svg";
    std::int64_t mutations = 2000;
};

int run(const TraceOptions& options) {
    check_writable(options.output);
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    RenderSettings settings;
    settings.mix = options.mix.apply_found(settings.mix);
    settings.mutations_per_pixel = 1;  // of no effect: chains end where they are told to
    const ChainTrace trace = trace_chain(*loaded.scene, settings, static_cast<std::uint64_t>(options.mutations));
    if (trace.steps.empty()) {
        fmt::print(stderr, "keyhole: no bootstrap path carries light: there is no chain\n");
        return exit_failure;
    }
    std::size_t accepted = 0;
    for (const TraceStep& step : trace.steps) accepted += step.accepted;
    write_file(options.output, trace_svg(trace, fmt::format("{}, {}", options.scene.filename, settings.mix.name)));
    fmt::print("{} of {} mutations accepted\nwrote {}\n", accepted, trace.steps.size(), options.output);
    return exit_success;
}

}  // namespace

void add_trace_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<TraceOptions>();
    CLI::App* command = keyhole.add_subcommand("trace", "Draw where a chain goes");
    add_scene_options(*command, options->scene);
    add_mix_options(*command, options->mix);
    add_integer(*command, "-n,--mutations", options->mutations, std::int64_t{1}, std::int64_t{1000000},
                "Steps of the chain [default: 2000]");
    add_mix_key(*command, options->mix, "--max-length", "lengths.max",
                "Most edges of a path [default: what the scene says, else 12]");
    add_mix_key(*command, options->mix, "--seed", "seed", "Another seed starts another chain [default: the mix's]");
    command->add_option("-o,--output", options->output, "Picture [default: trace.svg]")->option_text("FILE");
    command->footer(footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
