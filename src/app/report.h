// What a run was and what it found, as JSON: the file beside the image, and the image's metadata.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/options.h"
#include "render/render.h"
#include "scene/reader.h"

namespace keyhole {

using Json = nlohmann::ordered_json;

// Everything known before the first sample: versions, command line, scene, film, settings (resolved).
Json describe_run(const SceneOptions& options, const LoadedScene& loaded, const RenderSettings& settings);

// Adds what the run has found to `report`.
void add_statistics(Json& report, const RenderSettings& settings, const Scene& scene,
                    const RenderStatistics& statistics);

std::string scene_hash(const Scene& scene);  // 16 hexadecimal digits

Json film_json(const FilmSettings& film);

// As text on one line, or indented. Bytes of names that are not UTF-8 are replaced: no run is lost to them.
std::string json_text(const Json& json, int indent = -1);

// Image attributes: the main entries by name ("keyhole:seed") for people and scripts, and all of it as JSON
// ("keyhole:run").
std::map<std::string, std::string> image_metadata(const Json& report);

Integrator integrator_of(const std::string& name);  // throws InputError for other names
const char* work_unit(Integrator integrator);       // "mutations" or "samples"

// Over all strategies; negative where nothing was proposed.
double overall_acceptance(const RenderStatistics& statistics);

}  // namespace keyhole
