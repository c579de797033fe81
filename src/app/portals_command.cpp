// `keyhole portals`
#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/interrupt.h"
#include "app/options.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "render/find_portals.h"
#include "strategies/registry.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
Draws paths with light and looks for the openings that they squeeze through; writes
rectangles over these as a scene file, to be used with --portals, and edited at will:
whatever the portals are, the image stays right, only its noise depends on them.

Examples:
  keyhole portals room.xml -o portals.xml
  keyhole render room.xml --portals portals.xml --mix portal

Exit codes: 0 done; 1 the file cannot be written, or no path with light was found;
2 options or scene not valid; 130, 143, 129 ended by Ctrl-C, SIGTERM, SIGHUP.)";

struct PortalsOptions {
    SceneOptions scene;
    PortalSearch search;
    std::string output = "portals.xml";
};

int run(const PortalsOptions& options) {
    check_writable(options.output);
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    const InterruptGuard interrupt(true);
    const FoundPortals found = find_portals(*loaded.scene, options.search, [&] { return interrupt.signal() != 0; });
    if (interrupt.signal() != 0) return exit_signal + interrupt.signal();
    fmt::print("{} paths with light among {} drawn\n", found.paths, found.tries);
    if (found.paths == 0) {
        fmt::print(stderr, "keyhole: no path with light was found; more --tries may help\n");
        return exit_failure;
    }
    if (found.portals.empty())
        fmt::print("no openings that {:g}% of the light passes\n", 100 * options.search.least_share);
    for (std::size_t i = 0; i < found.portals.size(); ++i) {
        const FoundPortal& p = found.portals[i];
        const Vec3 c = p.face.at({0.5, 0.5});
        fmt::print(
            "portal-{}  {:.3g} x {:.3g} about ({:.4g}, {:.4g}, {:.4g}), normal ({:.3f}, {:.3f}, {:.3f}): "
            "{:.1f}% of the light, {:.1f}% of its paths\n",
            i + 1, p.face.e1.norm(), p.face.e2.norm(), c.x(), c.y(), c.z(), p.face.n.x(), p.face.n.y(), p.face.n.z(),
            100 * p.share, 100 * p.paths_share);
    }
    write_file(options.output,
               portals_xml(found, fmt::format("Portals of {}, found by keyhole portals.", options.scene.filename)));
    fmt::print("wrote {}\n", options.output);
    return exit_success;
}

}  // namespace

void add_portals_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<PortalsOptions>();
    CLI::App* command = keyhole.add_subcommand("portals", "Find the openings that a scene's light passes through");
    add_scene_options(*command, options->scene);
    command->add_option("-o,--output", options->output, "Scene file of portals [default: portals.xml]")
        ->option_text("FILE");
    PortalSearch& s = options->search;
    add_integer(*command, "--paths", s.paths, 100, 1000000, "Paths with light that are enough [default: 40000]");
    add_integer(*command, "--tries", s.tries, std::int64_t{1000}, std::int64_t{1000000000000},
                "Paths to draw for that at most [default: 2000000]");
    add_integer(*command, "--most", s.most, 1, 1000, "Portals at most [default: 8]");
    add_real(*command, "--least-share", s.least_share, 0, 1, "Of the light, for an opening to count [default: 0.05]");
    add_integer(*command, "--max-length", s.max_length, 1, PathLengths::longest,
                "Most edges of a path [default: what the scene says, else 8]");
    add_integer(*command, "--seed", s.seed, std::int64_t{0}, std::numeric_limits<std::int64_t>::max(),
                "Another seed draws other paths [default: 0]");
    command->footer(footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
