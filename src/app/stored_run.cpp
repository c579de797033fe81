#include "app/stored_run.h"

#include <filesystem>
#include <fstream>

#include "app/report.h"
#include "base/error.h"

namespace keyhole {
namespace {

Json read_description(const std::string& filename) {
    if (!filename.ends_with(".json")) {
        const std::string text = read_metadata(filename, "keyhole:run");
        if (text.empty())
            throw InputError({filename}, "the image does not say how it was made (keyhole:run is missing)");
        return Json::parse(text);
    }
    std::ifstream file(filename);
    if (!file) throw InputError({filename}, "the report cannot be read");
    return Json::parse(file);
}

// Where the scene is now: where it was, or what its name as given then leads to from here.
std::string find_scene(const Json& scene) {
    const std::string path = scene.at("path"), file = scene.at("file");
    return std::filesystem::exists(path) ? path : file;
}

SceneOptions scene_options(const Json& scene) {
    SceneOptions options;
    options.filename = find_scene(scene);
    options.reader.defines = scene.at("defines").get<std::map<std::string, std::string>>();
    options.reader.lenient = scene.at("lenient");
    if (const Json& portals = scene.at("portals"); !portals.is_null()) options.reader.portals = portals;
    if (const Json& size = scene.at("size"); !size.is_null()) {
        options.reader.width = size.at(0);
        options.reader.height = size.at(1);
    }
    if (const Json& crop = scene.at("crop"); !crop.is_null()) {
        options.reader.override_crop = true;
        options.reader.crop_x = crop.at(0);
        options.reader.crop_y = crop.at(1);
        options.reader.crop_width = crop.at(2);
        options.reader.crop_height = crop.at(3);
    }
    if (const Json& filter = scene.at("filter"); !filter.is_null()) options.reader.filter = filter_of(filter);
    return options;
}

RenderSettings run_settings(const Json& run, const std::string& filename) {
    const Json& json = run.at("settings");
    if (!run.contains("statistics"))
        throw InputError({filename}, "this is a preview; the final image of the run can be made again");
    const auto rounds = run.at("statistics").at("rounds").get<std::int64_t>();
    RenderSettings settings;
    settings.integrator = integrator_of(json.at("integrator"));
    if (settings.integrator == Integrator::mmlt) {
        settings.mix = parse_mix(json.at("mix"), filename + " (mix)");
        settings.mix.chain_length = rounds;
    } else {
        settings.mix.seed = json.at("seed");
        settings.mix.lengths.min = json.at("min_length");
        settings.mix.lengths.max = json.at("max_length");
        settings.mutations_per_pixel = static_cast<double>(rounds);
    }
    return settings;
}

}  // namespace

StoredRun read_stored_run(const std::string& filename) {
    try {
        const Json run = read_description(filename);
        return {filename, scene_options(run.at("scene")), run_settings(run, filename), run.at("scene").at("hash"),
                run.at("versions").at("keyhole")};
    } catch (const Json::exception& e) {
        throw InputError({filename}, std::string("no complete description of a run: ") + e.what());
    }
}

SceneOptions merge(const SceneOptions& stored, const SceneOptions& given) {
    SceneOptions result = stored;
    if (!given.filename.empty()) result.filename = given.filename;
    const ReaderOptions& from = given.reader;
    ReaderOptions& to = result.reader;
    for (const auto& [name, value] : from.defines) to.defines[name] = value;
    to.lenient = to.lenient || from.lenient;
    if (!from.portals.empty()) to.portals = from.portals;
    if (from.filter) to.filter = from.filter;
    if (from.width > 0) {
        to.width = from.width;
        to.height = from.height;
    }
    if (from.width > 0 || from.override_crop) {  // a crop window belongs to a size
        to.override_crop = from.override_crop;
        to.crop_x = from.crop_x;
        to.crop_y = from.crop_y;
        to.crop_width = from.crop_width;
        to.crop_height = from.crop_height;
    }
    return result;
}

}  // namespace keyhole
