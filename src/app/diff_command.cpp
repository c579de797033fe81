// `keyhole diff`
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/report.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "compare/false_colour.h"
#include "compare/metrics.h"

namespace keyhole {
namespace {

struct DiffOptions {
    std::string image, reference, mask, error_image;
    double error_maximum = 0;  // 0: the 99.9th percentile
    std::vector<MetricInfo> metrics;
    bool json = false;
};

constexpr double default_quantile = 0.999;

std::string footer() {
    std::string text = "Metrics (I: image, R: reference, mean: over pixels and channels):\n";
    for (const MetricInfo& metric : metric_list()) text += fmt::format("  {:<15} {}\n", metric.name, metric.formula);
    return text + R"(
Pixels where a value is not finite are left out, counted and warned about.
FLIP is not among them: no packaged library computes it.

Examples:
  keyhole diff out.exr ref.exr
  keyhole diff out.exr ref.exr --mask no-lights.png --error-image error.png
  keyhole diff out.exr ref.exr --metric rrmse      prints the number alone

Exit codes: 0 compared; 1 failure while running; 2 options or images not valid,
sizes that differ.)";
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const MetricInfo& metric : metric_list()) names.emplace_back(metric.name);
    return names;
}

Json rgb_json(const Spectrum& s) { return {s[0], s[1], s[2]}; }

Json metrics_json(const DiffOptions& options, const ErrorMetrics& m) {
    Json json = {{"image", options.image},
                 {"reference", options.reference},
                 {"pixels", m.pixels},
                 {"masked", m.masked},
                 {"non_finite", m.non_finite}};
    json["metrics"] = Json::object();
    for (const MetricInfo& metric : metric_list())
        json["metrics"][metric.name] = {{"value", m.*metric.value}, {"formula", metric.formula}};
    json["mean_ratio_rgb"] = rgb_json(m.mean_ratio);
    json["mean_rgb"] = rgb_json(m.mean);
    json["mean_reference_rgb"] = rgb_json(m.mean_reference);
    return json;
}

void print_table(const DiffOptions& options, const ErrorMetrics& m) {
    fmt::print("image      {}\nreference  {}\npixels     {} compared, {} masked, {} not finite\n\n", options.image,
               options.reference, m.pixels, m.masked, m.non_finite);
    for (const MetricInfo& metric : metric_list())
        fmt::print("{:<15} {:<12.6g} {}\n", metric.name, m.*metric.value, metric.formula);
    fmt::print("{:<15} {:.6g} {:.6g} {:.6g}\n", "  of R, G, B", m.mean_ratio[0], m.mean_ratio[1], m.mean_ratio[2]);
}

// Returns what the colours mean.
std::string write_error_image(const DiffOptions& options, const Image& image, const Image& reference,
                              const Image* mask) {
    const std::vector<double> errors = relative_errors(image, reference, mask);
    double maximum = options.error_maximum;
    if (maximum == 0) maximum = error_quantile(errors, default_quantile);
    if (!(maximum > 0)) maximum = 1;
    const std::string scale = fmt::format(
        "sqrt of the mean over the channels of (I-R)^2 / (R^2 + 0.001 mean(R)^2), black 0 to pale yellow {:.4g} and "
        "more, "
        "grey: left out",
        maximum);
    WriteOptions write;
    write.metadata = {
        {"keyhole:scale", scale}, {"keyhole:image", options.image}, {"keyhole:reference", options.reference}};
    write_image(options.error_image, false_colour(errors, image.width, maximum), write);
    return scale;
}

int run_diff(const DiffOptions& options) {
    if (!options.error_image.empty()) {
        image_format(options.error_image);
        check_writable(options.error_image);
    }
    const Image image = read_image(options.image), reference = read_image(options.reference);
    std::optional<Image> mask;
    if (!options.mask.empty()) mask = read_image(options.mask);
    const Image* mask_or_null = mask ? &*mask : nullptr;
    const ErrorMetrics metrics = compare_images(image, reference, mask_or_null);
    if (metrics.non_finite > 0)
        print_warning(fmt::format("{} pixels with values that are not finite are left out", metrics.non_finite));

    Json json = metrics_json(options, metrics);
    std::string scale;
    if (!options.error_image.empty()) {
        scale = write_error_image(options, image, reference, mask_or_null);
        json["error_image"] = {{"file", options.error_image}, {"scale", scale}};
    }
    if (options.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.metrics.empty()) {
        for (const MetricInfo& metric : options.metrics) fmt::print("{:.9g}\n", metrics.*metric.value);
    } else {
        print_table(options, metrics);
        if (!scale.empty()) fmt::print("\nwrote {}: {}\n", options.error_image, scale);
    }
    return exit_success;
}

}  // namespace

void add_diff_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<DiffOptions>();
    CLI::App* command = keyhole.add_subcommand("diff", "Measure how far an image is from a reference");
    command->add_option("IMAGE", options->image, "The image to judge; any format OpenImageIO reads")->required();
    command->add_option("REFERENCE", options->reference, "What it should be, of the same size")->required();
    command->add_option("--mask", options->mask, "Leave out the pixels that are black in this image")
        ->type_name("FILE");
    command
        ->add_option("--error-image", options->error_image,
                     "Write the error of each pixel in false colours, .png or .exr")
        ->type_name("FILE");
    add_real(*command, "--error-maximum", options->error_maximum, 0, 1e30,
             "The error that gets the last colour [default: the 99.9th percentile]", true);
    const auto choose = [options](std::size_t i) { options->metrics.push_back(metric_list()[i]); };
    CLI::Option* metric =
        add_choice(*command, "--metric", metric_names(), choose, "Print this number alone; repeatable, one line each")
            ->take_all();
    command->add_flag("--json", options->json, "Print everything as JSON")->excludes(metric);
    command->footer(footer());
    command->callback([options, &runner] { runner = [options] { return run_diff(*options); }; });
}

}  // namespace keyhole
