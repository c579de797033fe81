// `keyhole info`
#include <fmt/format.h>

#include <map>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/report.h"
#include "base/process.h"
#include "base/units.h"

namespace keyhole {
namespace {

struct InfoOptions {
    SceneOptions scene;
    bool json = false;
};

struct Requirement {
    const char* name;
    bool value;
    const char* meaning;
};

std::vector<Requirement> requirement_list(const Requirements& r) {
    return {{"finite_aperture", r.aperture, "two lens coordinates"},
            {"environment", r.environment, "rays that escape carry light"},
            {"infinite_emitters", r.infinite_emitters, "path ends that are directions"},
            {"delta_emitters", r.delta_emitters, "lights that no ray can hit"},
            {"smooth_lobes", r.bsdfs.smooth, "vertices that can be connected"},
            {"delta_lobes", r.bsdfs.delta, "vertices that cannot: mirrors, clear glass"},
            {"layered_lobes", r.bsdfs.chooses_lobe, "a lobe coordinate at each vertex"},
            {"transmission", r.bsdfs.transmissive, "light passes through surfaces"},
            {"textures", r.bsdfs.needs_uv, "texture lookups in BSDFs"},
            {"tangents", r.bsdfs.needs_tangents, "anisotropic or bump-mapped surfaces"}};
}

std::map<std::string, int> emitter_kinds(const Scene& scene) {
    std::map<std::string, int> kinds;
    for (const Emitter* emitter : scene.emitters()) ++kinds[emitter->name()];
    return kinds;
}

// Each strategy's name, and why it can never move a chain here (empty: it can), among lengths as render chooses them.
std::vector<std::pair<std::string, std::string>> hindrances(const Scene& scene) {
    RenderSettings settings;
    settings.mutations_per_pixel = 1;
    const PathLengths lengths = resolve(scene, settings).mix.lengths;
    std::vector<std::pair<std::string, std::string>> list;
    for (const StrategyInfo& s : strategy_registry()) list.emplace_back(s.name, s.hindrance(scene, lengths));
    return list;
}

Json max_length_json(const Scene& scene) {
    if (scene.max_path_length() == 0) return nullptr;
    return scene.max_path_length() < 0 ? Json("unbounded") : Json(scene.max_path_length());
}

Json info_json(const InfoOptions& options, const LoadedScene& loaded) {
    const Scene& scene = *loaded.scene;
    const SceneStatistics& s = scene.statistics();
    const FilmSettings& film = scene.film();
    Json json = {{"file", options.scene.filename}, {"hash", scene_hash(scene)}};
    json["shapes"] = {{"shapes", s.shapes},
                      {"instances", s.instances},
                      {"triangles", s.triangles},
                      {"unique_triangles", s.unique_triangles}};
    json["bsdfs"] = s.bsdfs;
    json["textures"] = s.textures;
    json["emitters"] = {{"count", s.emitters}, {"kinds", emitter_kinds(scene)}};
    json["portals"] = scene.portals().names().size();
    json["sensor"] = scene.sensor().name();
    json["film"] = film_json(film);
    json["max_length"] = max_length_json(scene);
    const Vec3 c = scene.center();
    json["bounding_sphere"] = {{"center", {c.x(), c.y(), c.z()}}, {"radius", scene.radius()}};
    json["memory_bytes"] = {{"meshes", s.mesh_bytes},
                            {"textures", s.texture_bytes},
                            {"embree", s.embree_bytes},
                            {"peak", peak_memory_bytes()}};
    json["seconds"] = {{"reading", loaded.seconds_reading}, {"building", loaded.seconds_building}};
    json["requires"] = Json::object();
    for (const Requirement& r : requirement_list(scene.requirements())) json["requires"][r.name] = r.value;
    json["strategies"] = Json::object();
    for (const auto& [name, why] : hindrances(scene)) json["strategies"][name] = why.empty() ? Json(true) : Json(why);
    json["unused"] = loaded.unused;
    json["warnings"] = loaded.warnings;
    return json;
}

void print_list(const char* title, const std::vector<std::string>& lines) {
    if (!lines.empty()) fmt::print("\n{}\n", title);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
}

void print_contents(const Scene& scene) {
    const SceneStatistics& s = scene.statistics();
    fmt::print("shapes      {} ({} instances); {} triangles as traced, {} in memory\n", s.shapes, s.instances,
               s.triangles, s.unique_triangles);
    std::string kinds;
    for (const auto& [kind, count] : emitter_kinds(scene))
        kinds += fmt::format("{}{} {}", kinds.empty() ? ": " : ", ", count, kind);
    fmt::print("emitters    {}{}\nBSDFs       {}\ntextures    {}\nportals     {}\n", s.emitters, kinds, s.bsdfs,
               s.textures, scene.portals().names().size());
}

void print_info(const InfoOptions& options, const LoadedScene& loaded) {
    const Scene& scene = *loaded.scene;
    const SceneStatistics& s = scene.statistics();
    const FilmSettings& film = scene.film();
    fmt::print("scene       {} (hash {})\n", options.scene.filename, scene_hash(scene));
    print_contents(scene);
    fmt::print("sensor      {}, film {}x{}, window {}x{} at {},{}, {} filter of radius {:g}\n", scene.sensor().name(),
               film.width, film.height, film.crop_width, film.crop_height, film.crop_x, film.crop_y, film.filter.name(),
               film.filter.radius);
    fmt::print("paths       {}\n", scene.max_path_length() == 0 ? "the file sets no greatest length"
                                   : scene.max_path_length() < 0
                                       ? "of any length"
                                       : fmt::format("up to {} edges", scene.max_path_length()));
    const Vec3 c = scene.center();
    fmt::print("bounds      sphere of radius {:.6g} about ({:.6g}, {:.6g}, {:.6g})\n", scene.radius(), c.x(), c.y(),
               c.z());
    fmt::print("memory      meshes {}, textures {}, Embree {}; peak of loading {}\n", format_bytes(s.mesh_bytes),
               format_bytes(s.texture_bytes), format_bytes(s.embree_bytes), format_bytes(peak_memory_bytes()));
    fmt::print("time        read in {}, built in {}\n\nrequires\n", format_duration(loaded.seconds_reading),
               format_duration(loaded.seconds_building));
    for (const Requirement& r : requirement_list(scene.requirements()))
        fmt::print("  {:<18} {:<4} {}\n", r.name, r.value ? "yes" : "no", r.meaning);
    fmt::print("\nstrategies\n");
    for (const auto& [name, why] : hindrances(scene))
        fmt::print("  {:<18} {}\n", name, why.empty() ? "yes" : "no   " + why);
    print_list("unused", loaded.unused);
    for (const std::string& warning : loaded.warnings) print_warning(warning);
}

}  // namespace

void add_info_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = keyhole.add_subcommand("info", "Say what a scene holds, requires and leaves unused");
    add_scene_options(*command, options->scene);
    command->add_flag("--json", options->json, "Print everything as JSON");
    command->footer("Exit codes: 0 read; 1 failure while running; 2 options or scene not valid.");
    command->callback([options, &runner] {
        runner = [options] {
            const LoadedScene loaded = read_scene(options->scene.filename, options->scene.reader);
            if (options->json)
                fmt::print("{}\n", info_json(*options, loaded).dump(2));
            else
                print_info(*options, loaded);
            return exit_success;
        };
    });
}

}  // namespace keyhole
