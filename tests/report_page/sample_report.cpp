// Writes a report with made-up results and images of known noise, for the test of the page in a browser.
//
//   sample_report FILE WIDTH HEIGHT ENTRIES [sweep|bare]
//
// `sweep`: the entries are values of a parameter. `bare`: the results hold only what they must, and there is no image.
//
// The reference is a smooth pattern R; entry i (from 0) is R times a uniform number in 1 +- 0.4 / (i + 1). Pixel (0, 0)
// is 100000 i in every channel, beyond what a half can hold, and (1, 0) of entry 0 is not a number.
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/report.h"

namespace {

using keyhole::Image;
using nlohmann::json;

Image reference_image(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height, r = std::hypot(u - 0.62, v - 0.45);
            const double light =
                0.04 + 2.5 * std::exp(-60 * r * r) + 0.25 * (0.5 + 0.5 * std::sin(18 * u) * std::cos(9 * v));
            image.pixel(x, y)[0] = static_cast<float>(light);
            image.pixel(x, y)[1] = static_cast<float>(light * (0.55 + 0.4 * v));
            image.pixel(x, y)[2] = static_cast<float>(light * (0.9 - 0.6 * u));
        }
    return image;
}

Image noisy_image(const Image& reference, int entry) {
    Image image = reference;
    std::mt19937 random(static_cast<unsigned>(entry) + 1);
    std::uniform_real_distribution<float> factor(1 - 0.4f / static_cast<float>(entry + 1),
                                                 1 + 0.4f / static_cast<float>(entry + 1));
    for (float& v : image.rgb) v *= factor(random);
    for (int c = 0; c < 3; ++c) image.pixel(0, 0)[c] = 1e5f * static_cast<float>(entry);
    if (entry == 0) image.pixel(1, 0)[0] = std::numeric_limits<float>::quiet_NaN();
    return image;
}

json estimate(double mean, double spread = 0.12) {
    return {{"mean", mean}, {"low", mean * (1 - spread)}, {"high", mean * (1 + spread)}};
}

json strategy(const char* name, int proposals, double acceptance) {
    return {
        {"name", name},
        {"proposals", proposals},
        {"accepted", static_cast<int>(acceptance * proposals)},
        {"mean_acceptance", acceptance},
        {"failures", {{"occluded", proposals / 7}, {"zero_bsdf", proposals / 31}, {"outside_film", proposals / 90}}},
        {"effective_sample_size", 0.02 * proposals},
        {"autocorrelation_time", 50}};
}

json convergence(double error) {
    json points = json::array();
    for (int i = 0; i < 7; ++i) {
        const double seconds = 0.9375 * (1 << i), variance = error * 60 / seconds;
        points.push_back({{"seconds", seconds},
                          {"mutations", 2.4e6 * seconds},
                          {"relmse", estimate(variance + 0.05 * error)},
                          {"variance", estimate(variance)},
                          {"squared_bias",
                           {{"mean", (i == 4 ? -0.1 : 0.05) * error}, {"low", -0.3 * error}, {"high", 0.4 * error}}}});
    }
    return points;
}

json entry(int i) {
    const std::array names = {"mmlt",   "mmlt, large steps 0.1",
                              "cmlt",   "rjmlt",
                              "fused",  "geometry-aware",
                              "portal", "manifold",
                              "retry",  "walk-on",
                              "path",   "bdpt"};
    const double error = 0.16 / 3 / ((i + 1) * (i + 1));
    const double time = 1.0 + i;
    json result = {{"name", i == 2 ? "</script><b>\"Ö\" & 'λ'" : names[static_cast<std::size_t>(i) % names.size()]},
                   {"kind", "mix"},
                   {"mix",
                    "name = \"sample\"\ntarget = \"luminance\"\n\n[[strategy]]\nname = \"small-step\"\nweight = "
                    "0.7\nsigma = 0.01\n"},
                   {"runs", 10},
                   {"metrics",
                    {{"mse", estimate(0.4 * error)},
                     {"rrmse", estimate(std::sqrt(error), 0.06)},
                     {"relmse", estimate(error)},
                     {"mape", estimate(0.8 * std::sqrt(error), 0.05)},
                     {"smape", estimate(0.7 * std::sqrt(error), 0.05)},
                     {"mean_ratio", estimate(1.0003, 0.004)}}},
                   {"split",
                    {{"variance", estimate(0.95 * error)},
                     {"squared_bias", {{"mean", 0.05 * error}, {"low", -0.3 * error}, {"high", 0.4 * error}}}}},
                   {"convergence", convergence(error)},
                   {"strategies", {strategy("large step", 43210987, 0.11), strategy("small step", 98765432, 0.63)}},
                   {"mutations_per_second", estimate(2.4e6 / (1 + 0.1 * i), 0.01)},
                   {"time_split",
                    {{"tracing", 0.5},
                     {"shading", 0.2},
                     {"inversion", 0.02 * time},
                     {"film", 0.05},
                     {"other", 0.25 - 0.02 * time}}}};
    if (i > 0) result["speed_up"] = estimate((i + 1.0) * (i + 1.0), 0.2);
    if (i == 1) result["warnings"] = {"groups of chains disagree more than their noise explains"};
    return result;
}

json results(int width, int height, int entries) {
    json all = {
        {"format", "keyhole-results"},
        {"version", 1},
        {"scene",
         {{"file", "scenes/sample.xml"}, {"name", "Sample"}, {"width", width}, {"height", height}, {"max_length", 12}}},
        {"command", "keyhole compare scenes/sample.xml --mixes a,b,c --time 60s --runs 10 -o sample"},
        {"equal", "time"},
        {"budget", 60},
        {"runs", 10},
        {"threads", 2},
        {"seed", 1},
        {"keyhole", "0.1.0"},
        {"machine", "a made-up processor, 2 threads"},
        {"reference",
         {{"integrator", "bdpt"},
          {"samples_per_pixel", 65536},
          {"seconds", 600},
          {"relmse", 2e-4},
          {"file", "reference.exr"}}},
        {"entries", json::array()}};
    for (int i = 0; i < entries; ++i) all["entries"].push_back(entry(i));
    return all;
}

void make_sweep(json& all) {
    double value = 0.001;
    for (json& entry : all["entries"]) {
        entry["parameter"] = {{"name", "small-step.sigma"}, {"value", value}};
        value *= 3;
    }
}

void make_bare(json& all) {
    all = {{"format", all["format"]},
           {"version", all["version"]},
           {"scene", {{"file", "scenes/sample.xml"}}},
           {"entries", {{{"name", "mmlt"}}}}};
}

}  // namespace

int main(int count, char** arguments) {
    try {
        if (count < 5) throw std::invalid_argument("usage: sample_report FILE WIDTH HEIGHT ENTRIES [sweep|bare]");
        const int width = std::atoi(arguments[2]), height = std::atoi(arguments[3]), entries = std::atoi(arguments[4]);
        const std::string kind = count > 5 ? arguments[5] : "";
        json all = results(width, height, entries);
        std::vector<keyhole::ReportImage> images = {{"reference", reference_image(width, height)}};
        for (int i = 0; i < entries; ++i)
            images.push_back({all["entries"][static_cast<std::size_t>(i)]["name"], noisy_image(images[0].image, i)});
        if (kind == "sweep") make_sweep(all);
        if (kind == "bare") {
            make_bare(all);
            images.clear();
        }
        keyhole::write_report(arguments[1], all, images);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
