#include "app/outputs.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/atomic_file.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;

// Runs `write` on the file, else on one of the same name in the temporary folder. Returns what went wrong.
std::string write_or_rescue(const std::string& filename, const std::function<void(const std::string&)>& write) {
    try {
        write(filename);
        return "";
    } catch (const std::exception& e) {
        std::string message = e.what();
        try {
            const std::string rescue = (fs::temp_directory_path() / fs::path(filename).filename()).string();
            write(rescue);
            return message + "; it was written to '" + rescue + "' instead";
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

Outputs::Outputs(std::vector<std::string> names, const std::string& scene_filename, double exposure)
    : images_(std::move(names)), exposure_(exposure) {
    if (images_.empty()) images_.push_back(scene_name(scene_filename) + ".exr");
    report_ = fs::path(images_.front()).replace_extension(".json").string();
    for (const std::string& name : images_) image_format(name);
    for (const std::string& name : images_) check_writable(name);
    check_writable(report_);
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

std::vector<std::string> Outputs::write(const Image& image, const Json& run) const {
    std::vector<std::string> failures;
    const auto keep = [&failures](std::string message) {
        if (!message.empty()) failures.push_back(std::move(message));
    };
    const WriteOptions options = write_options(run);
    for (const std::string& name : images_)
        keep(write_or_rescue(name, [&](const std::string& file) { write_image(file, image, options); }));
    keep(write_or_rescue(report_, [&](const std::string& file) { write_file(file, json_text(run, 2) + "\n"); }));
    return failures;
}

}  // namespace keyhole
