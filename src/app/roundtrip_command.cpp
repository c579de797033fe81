// `keyhole roundtrip`
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/options.h"
#include "inverse/round_trips.h"
#include "strategies/registry.h"

namespace keyhole {
namespace {

// What counts as out of bounds.
constexpr double most_failures = 1e-3;      // of the tries of a sampler
constexpr double false_alarm_level = 1e-3;  // of all chi-square tests together

constexpr const char* footer = R"(
Draws paths by every technique, finds the numbers by which every other technique
makes them, and traces those again. For each sampler: tries, failures by cause,
and how far what came back is from where it was, in units of the sampler's width
(1 / sqrt of its density). The numbers found must be distributed as drawn ones:
p-values of a two-sample chi-square test for each kind.

Exit codes: 0 within bounds (failures below 1 in 1000 for each sampler, p-values
with a false alarm in 1000 runs); 1 out of bounds; 2 options or scene not valid.

Example: keyhole roundtrip scenes/glossy-room.xml --paths 100000)";

struct RoundTripOptions {
    SceneOptions scene;
    std::int64_t paths = 20000, seed = 0;
    int max_length = 0;
    bool json = false;
};

double failure_share(const SamplerRoundTrips& s) {
    return s.tries > 0 ? static_cast<double>(s.failed()) / static_cast<double>(s.tries) : 0;
}

double p_value_bound(const RoundTrips& r) {
    return false_alarm_level / static_cast<double>(std::max<std::size_t>(1, r.coordinates.size()));
}

bool within_bounds(const RoundTrips& r) {
    return std::all_of(r.samplers.begin(), r.samplers.end(),
                       [](const SamplerRoundTrips& s) { return failure_share(s) <= most_failures; }) &&
           std::all_of(r.coordinates.begin(), r.coordinates.end(),
                       [&r](const CoordinateTest& c) { return c.p_value > p_value_bound(r); });
}

nlohmann::ordered_json failures_json(const SamplerRoundTrips& s) {
    nlohmann::ordered_json failures = nlohmann::ordered_json::object();
    for (std::size_t i = 1; i < s.failures.size(); ++i)
        if (s.failures[i] > 0) failures[inverse_failure_names[i]] = s.failures[i];
    return failures;
}

nlohmann::ordered_json to_json(const RoundTrips& r) {
    nlohmann::ordered_json json = {{"paths", r.paths},
                                   {"negligible", r.negligible},
                                   {"inversions", r.inversions},
                                   {"impossible", r.impossible},
                                   {"within_bounds", within_bounds(r)}};
    json["samplers"] = json["coordinates"] = nlohmann::ordered_json::array();
    for (const SamplerRoundTrips& s : r.samplers)
        json["samplers"].push_back({{"kind", s.kind},
                                    {"name", s.name},
                                    {"tries", s.tries},
                                    {"worst", s.worst},
                                    {"percentile_99_9", s.percentile_99_9},
                                    {"failures", failures_json(s)}});
    for (const CoordinateTest& c : r.coordinates)
        json["coordinates"].push_back({{"name", c.name}, {"numbers", c.numbers}, {"p_value", c.p_value}});
    return json;
}

void print(const RoundTrips& r) {
    fmt::print("{} paths, {} of them negligible; {} inversions, {} impossible\n\n", r.paths, r.negligible, r.inversions,
               r.impossible);
    fmt::print("{:<28} {:>10} {:>10} {:>10} {:>10}  {}\n", "sampler", "tries", "exact", "99.9%", "worst", "failures");
    for (const SamplerRoundTrips& s : r.samplers) {
        std::string failures;
        for (std::size_t i = 1; i < s.failures.size(); ++i)
            if (s.failures[i] > 0)
                failures +=
                    fmt::format("{}{} {}", failures.empty() ? "" : ", ", inverse_failure_names[i], s.failures[i]);
        fmt::print("{:<28} {:>10} {:>10} {:>10.2g} {:>10.2g}  {}{}\n", s.kind + " " + s.name, s.tries,
                   s.tries - s.failed(), s.percentile_99_9, s.worst, failures,
                   failure_share(s) > most_failures ? "  OUT OF BOUNDS" : "");
    }
    fmt::print("\n{:<28} {:>10} {:>10}\n", "numbers", "count", "p-value");
    for (const CoordinateTest& c : r.coordinates)
        fmt::print("{:<28} {:>10} {:>10.3g}{}\n", c.name, c.numbers, c.p_value,
                   c.p_value > p_value_bound(r) ? "" : "  OUT OF BOUNDS");
}

int run(const RoundTripOptions& options) {
    const LoadedScene loaded = read_scene(options.scene.filename, options.scene.reader);
    const int of_scene = loaded.scene->max_path_length();
    const int max_length = options.max_length > 0 ? options.max_length : std::max(2, of_scene > 0 ? of_scene : 6);
    const auto paths = static_cast<std::uint64_t>(options.paths);
    const RoundTrips r =
        measure_round_trips(*loaded.scene, max_length, paths, 10000 * paths, static_cast<std::uint64_t>(options.seed));
    if (options.json)
        fmt::print("{}\n", to_json(r).dump(2));
    else
        print(r);
    return within_bounds(r) ? exit_success : exit_failure;
}

}  // namespace

void add_roundtrip_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<RoundTripOptions>();
    CLI::App* command =
        keyhole.add_subcommand("roundtrip", "Measure how exact the inverses of sampling are in a scene");
    add_scene_options(*command, options->scene);
    constexpr std::int64_t most = 1000000000;
    add_integer(*command, "--paths", options->paths, std::int64_t{1}, most, "Paths with light [default: 20000]");
    add_integer(*command, "--max-length", options->max_length, 2, PathLengths::longest,
                "Most edges of a path [default: the scene file's, else 6]");
    add_integer(*command, "--seed", options->seed, std::int64_t{0}, std::numeric_limits<std::int64_t>::max(),
                "Another seed draws other paths [default: 0]");
    command->add_flag("--json", options->json, "Print everything as JSON");
    command->footer(footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
