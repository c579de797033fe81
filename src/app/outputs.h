// The files of a run: images by name, and a JSON report beside the first.
#pragma once

#include <string>
#include <vector>

#include "app/report.h"
#include "render/image.h"

namespace keyhole {

class Outputs {
  public:
    // `names` as given with -o; none: the scene's name with .exr in the current folder. Throws InputError for unknown
    // extensions and std::runtime_error where no file can be written, so that a run does not find out at its end.
    // `error_image`: .exr, or empty for none.
    Outputs(std::vector<std::string> names, const std::string& scene_filename, double exposure,
            const std::string& error_image = "");

    const std::vector<std::string>& images() const { return images_; }
    const std::string& report() const { return report_; }
    const std::string& error_image() const { return error_image_; }

    // Writes the images only: something to look at while the run goes on.
    void write_preview(const Image& image, const Json& run) const;

    // Where a mix that was tuned is written to, for renders to come.
    const std::string& mix() const { return mix_; }

    // Writes images, their standard errors if they are asked for, report, and the mix if it was tuned. A file that cannot be written is written
    // to the system's temporary folder instead. Returns what went wrong, one message per file.
    std::vector<std::string> write(const Image& image, const Image& error, const Json& run) const;

  private:
    WriteOptions write_options(const Json& run) const;

    std::vector<std::string> images_;
    std::string report_, mix_, error_image_;
    double exposure_;
};

// "scenes/cornell-box.xml" gives "cornell-box"; "scenes/veach-ajar/scene.xml" gives "veach-ajar", as does scene_v3.xml.
std::string scene_name(const std::string& scene_filename);

}  // namespace keyhole
