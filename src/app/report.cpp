#include "app/report.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/version.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/units.h"

namespace keyhole {
namespace {

Json scene_json(const SceneOptions& options, const LoadedScene& loaded) {
    const ReaderOptions& r = options.reader;
    return {{"file", options.filename},
            {"path", std::filesystem::absolute(options.filename).string()},
            {"hash", scene_hash(*loaded.scene)},
            {"size", r.width > 0 ? Json{r.width, r.height} : Json()},
            {"crop", r.override_crop ? Json{r.crop_x, r.crop_y, r.crop_width, r.crop_height} : Json()},
            {"filter", r.filter ? Json(r.filter->name()) : Json()},
            {"defines", r.defines},
            {"portals", r.portals.empty() ? Json() : Json(r.portals)},
            {"lenient", r.lenient},
            {"triangles", loaded.scene->statistics().triangles},
            {"seconds_reading", loaded.seconds_reading},
            {"seconds_building", loaded.seconds_building},
            {"unused", loaded.unused}};
}

// As used, with every default filled in; the mix as the text of a mix file.
Json settings_json(const RenderSettings& s) {
    Json json = {{"integrator", integrator_name(s.integrator)},
                 {"seed", s.mix.seed},
                 {"seconds", s.seconds},
                 {"mutations_per_pixel", s.mutations_per_pixel},
                 {"min_length", s.mix.lengths.min},
                 {"max_length", s.mix.lengths.max},
                 {"threads", s.threads}};
    if (s.integrator == Integrator::mmlt) json["mix"] = write_mix(s.mix);
    return json;
}

Json strategy_json(const StrategyStatistics& s) {
    Json json = {{"name", s.name},
                 {"proposals", s.proposals},
                 {"accepted", s.accepted},
                 {"mean_acceptance", s.mean_acceptance},
                 {"failures", s.failures},
                 {"effective_sample_size", s.luminance.effective_sample_size},
                 {"autocorrelation_time", s.luminance.autocorrelation_time},
                 {"position_effective_sample_size", s.position.effective_sample_size},
                 {"position_autocorrelation_time", s.position.autocorrelation_time}};
    if (s.excluded > 0) json["excluded"] = s.excluded;
    if (s.second.proposals > 0)
        json["second_stage"] = {
            {"proposals", s.second.proposals}, {"accepted", s.second.accepted}, {"failures", s.second.failures}};
    return json;
}

Json errors_json(const ErrorStatistics& e) {
    return {{"replicates", e.replicates},
            {"image_mean_standard_error", e.image_mean},
            {"blocks_relative_standard_error", e.blocks_relative},
            {"effective_sample_size", e.luminance.effective_sample_size},
            {"autocorrelation_time", e.luminance.autocorrelation_time},
            {"position_effective_sample_size", e.position.effective_sample_size},
            {"position_autocorrelation_time", e.position.autocorrelation_time},
            {"disagreeing_light", e.disagreeing_light < 0 ? Json() : Json(e.disagreeing_light)},
            {"b_effective_paths", e.effective_paths},
            {"b_largest_share", e.heaviest_share},
            {"moved_starts", e.moved_starts},
            {"blocks", {{"columns", 16}, {"rows", 16}, {"mean", e.block_means}, {"standard_error", e.block_errors}}}};
}

Json length_json(const LengthStatistics& s) {
    return {{"length", s.length}, {"chains", s.chains}, {"b", s.b}, {"b_standard_error", s.b_standard_error}};
}

double per_second(std::uint64_t count, double seconds) {
    return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

// JSON values as metadata text, strings without quotes.
std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : json_text(value); }

}  // namespace

std::string json_text(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string scene_hash(const Scene& scene) { return hash_text(scene.content_hash()); }

Json film_json(const FilmSettings& film) {
    return {{"width", film.width},
            {"height", film.height},
            {"crop", {film.crop_x, film.crop_y, film.crop_width, film.crop_height}},
            {"filter", film.filter.name()},
            {"filter_radius", film.filter.radius}};
}

Json tuning_json(const TuningStatistics& t) {
    Json json = {{"winner", t.winner},
                 {"clear", t.clear},
                 {"mutations", t.mutations},
                 {"cpu_seconds", t.cpu_seconds},
                 {"contenders", Json::array()}};
    for (const auto& c : t.contenders)
        json["contenders"].push_back(
            {{"name", c.name}, {"mutations", c.mutations}, {"cpu_seconds", c.cpu_seconds}, {"error", c.error}});
    return json;
}

Integrator integrator_of(const std::string& name) {
    for (const Integrator integrator : {Integrator::path, Integrator::bdpt, Integrator::mmlt})
        if (name == integrator_name(integrator)) return integrator;
    throw InputError({}, "unknown integrator '" + name + "'; " + valid_names(name, {"path", "bdpt", "mmlt"}));
}

const char* work_unit(Integrator integrator) { return integrator == Integrator::mmlt ? "mutations" : "samples"; }

double overall_acceptance(const RenderStatistics& statistics) {
    double proposals = 0, expected = 0;
    for (const StrategyStatistics& s : statistics.strategies) {
        proposals += static_cast<double>(s.proposals);
        expected += static_cast<double>(s.proposals) * s.mean_acceptance;
    }
    return proposals > 0 ? expected / proposals : -1;
}

Json describe_run(const SceneOptions& options, const LoadedScene& loaded, const RenderSettings& settings) {
    return {{"versions", versions()},
            {"started", utc_now()},
            {"scene", scene_json(options, loaded)},
            {"film", film_json(loaded.scene->film())},
            {"settings", settings_json(settings)}};
}

void add_statistics(Json& report, const RenderSettings& settings, const Scene& scene, const RenderStatistics& s) {
    const double pixels = static_cast<double>(scene.film().crop_width) * scene.film().crop_height;
    Json json = {{"complete", !s.interrupted},
                 {"work_unit", work_unit(settings.integrator)},
                 {"mutations", s.mutations},
                 {"rounds", s.rounds},
                 {"mutations_per_pixel", static_cast<double>(s.mutations) / pixels},
                 {"mutations_per_second", per_second(s.mutations, s.seconds_render)},
                 {"rays", s.rays},
                 {"rays_per_second", per_second(s.rays, s.seconds_render)},
                 {"seconds_bootstrap", s.seconds_bootstrap},
                 {"seconds_render", s.seconds_render},
                 {"cpu_seconds", s.cpu_seconds},
                 {"b", s.b},
                 {"b_standard_error", s.b_standard_error}};
    if (overall_acceptance(s) >= 0) json["acceptance"] = overall_acceptance(s);
    json["chains"] = s.chains;
    json["threads"] = s.threads;
    json["max_length"] = s.max_length;
    json["non_finite"] = s.non_finite;
    json["peak_memory_bytes"] = s.peak_memory_bytes;
    json["strategies"] = Json::array();
    for (const StrategyStatistics& strategy : s.strategies) json["strategies"].push_back(strategy_json(strategy));
    if (s.errors.replicates > 0) json["errors"] = errors_json(s.errors);
    if (!s.lengths.empty()) json["lengths"] = Json::array();
    for (const LengthStatistics& length : s.lengths) json["lengths"].push_back(length_json(length));
    if (s.tuning) {
        json["tuning"] = tuning_json(*s.tuning);
        report["settings"]["mix"] = write_mix(s.mix);
    }
    report["finished"] = utc_now();
    report["statistics"] = std::move(json);
}

std::map<std::string, std::string> image_metadata(const Json& report) {
    std::map<std::string, std::string> metadata = {
        {"Software", "Keyhole " + version()},
        {"keyhole:version", version()},
        {"keyhole:scene", text_of(report.at("scene").at("file"))},
        {"keyhole:scene_hash", text_of(report.at("scene").at("hash"))},
        {"keyhole:run", json_text(report)},
    };
    for (const char* name : {"integrator", "seed"})
        metadata[std::string("keyhole:") + name] = text_of(report.at("settings").at(name));
    if (report.at("settings").contains("mix")) metadata["keyhole:mix"] = text_of(report["settings"]["mix"]);
    if (!report.contains("statistics")) return metadata;
    for (const char* name : {"complete", "mutations", "mutations_per_pixel", "max_length", "chains", "b",
                             "b_standard_error", "acceptance", "seconds_render", "non_finite"})
        if (report["statistics"].contains(name))
            metadata[std::string("keyhole:") + name] = text_of(report["statistics"][name]);
    return metadata;
}

}  // namespace keyhole
