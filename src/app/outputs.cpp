#include "app/outputs.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/atomic_file.h"
#include "base/error.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;

// The name, or the first of NAME-1, NAME-2, ... that no file has.
fs::path free_name(const fs::path& name) {
    fs::path free = name;
    for (int i = 1; fs::exists(free); ++i)
        free.replace_filename(name.stem().string() + "-" + std::to_string(i) + name.extension().string());
    return free;
}

// Runs `write` on the file, else on one of the same name in the temporary folder. Returns what went wrong.
std::string write_or_rescue(const std::string& filename, const std::function<void(const std::string&)>& write) {
    try {
        write(filename);
        return "";
    } catch (const std::exception& e) {
        std::string message = e.what();
        try {
            const fs::path rescue = free_name(fs::temp_directory_path() / fs::path(filename).filename());
            write(rescue.string());
            return message + "; it was written to '" + rescue.string() + "' instead";
        } catch (const std::exception& second) {
            return message + "; " + second.what();
        }
    }
}

}  // namespace

std::string scene_name(const std::string& scene_filename) {
    const fs::path path = fs::absolute(scene_filename);
    const std::string stem = path.stem().string(), folder = path.parent_path().filename().string();
    const bool says_nothing = stem == "scene" || stem.starts_with("scene_v");
    return says_nothing && !folder.empty() ? folder : stem;
}

Outputs::Outputs(std::vector<std::string> names, const std::string& scene_filename, double exposure,
                 const std::string& error_image)
    : images_(std::move(names)), error_image_(error_image), exposure_(exposure) {
    if (images_.empty()) images_.push_back(scene_name(scene_filename) + ".exr");
    report_ = fs::path(images_.front()).replace_extension(".json").string();
    mix_ = fs::path(images_.front()).replace_extension(".mix.toml").string();
    for (const std::string& name : images_) image_format(name);
    for (const std::string& name : images_) check_writable(name);
    check_writable(report_);
    if (error_image_.empty()) return;
    if (image_format(error_image_) != "openexr")
        throw InputError({}, "--error-image '" + error_image_ + "' must be .exr: standard errors are no colours");
    if (std::find(images_.begin(), images_.end(), error_image_) != images_.end())
        throw InputError({}, "--error-image and -o name the same file, '" + error_image_ + "'");
    check_writable(error_image_);
}

WriteOptions Outputs::write_options(const Json& run) const {
    WriteOptions options;
    options.metadata = image_metadata(run);
    options.exposure = exposure_;
    return options;
}

void Outputs::write_preview(const Image& image, const Json& run) const {
    const WriteOptions options = write_options(run);
    for (const std::string& name : images_) write_image(name, image, options);
}

std::vector<std::string> Outputs::write(const Image& image, const Image& error, const Json& run) const {
    std::vector<std::string> failures;
    const auto keep = [&failures](std::string message) {
        if (!message.empty()) failures.push_back(std::move(message));
    };
    const WriteOptions options = write_options(run);
    for (const std::string& name : images_)
        keep(write_or_rescue(name, [&](const std::string& file) { write_image(file, image, options); }));
    if (!error_image_.empty()) {
        WriteOptions of_error = options;
        of_error.metadata["keyhole:content"] =
            "standard error of each value of the image, by the disagreement of independent replicates of the run";
        keep(write_or_rescue(error_image_, [&](const std::string& file) { write_image(file, error, of_error); }));
    }
    keep(write_or_rescue(report_, [&](const std::string& file) { write_file(file, json_text(run, 2) + "\n"); }));
    if (run.at("statistics").contains("tuning"))
        keep(write_or_rescue(
            mix_, [&](const std::string& file) { write_file(file, run.at("settings").at("mix").get<std::string>()); }));
    return failures;
}

}  // namespace keyhole
