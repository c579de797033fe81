// Section 7.1 of the charted paper: direct light of two lights behind obstacles, by six algorithms of two techniques,
// next-event estimation (1) and hitting the light (2).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "base/parallel.h"
#include "compare/error_split.h"
#include "compare/metrics.h"
#include "compare/reference.h"
#include "experiments/experiment.h"
#include "experiments/plot.h"
#include "scene/reader.h"

namespace keyhole {
namespace {

constexpr double samples[] = {16e6, 128e6};  // of all chains of a run together, as published
constexpr const char* sample_names[] = {"16 million", "128 million"};

struct Algorithm {
    const char* name;
    double published[2];  // RMSE, of another scene of the same description
    Mix mix;
};

Mix base_mix(LightVertices light, int chains) {
    Mix mix = builtin_mix("pssmlt-mix");
    mix.lengths = {2, 2, false};
    mix.techniques.light_vertices = light;
    mix.chain_count = chains;
    return mix;
}

std::vector<Algorithm> algorithms() {
    using L = LightVertices;
    Mix average = base_mix(L::at_most_one, 2);
    average.techniques.weighting = Weighting::splat;
    Mix path_space = builtin_mix("cmlt-ipsm");
    path_space.lengths = {2, 2, false};
    path_space.techniques.light_vertices = L::at_most_one;
    path_space.chain_count = 1;
    Mix charted = base_mix(L::at_most_one, 2);
    charted.exchange_every = 4;
    return {{"PSSMLT-1", {8.287e-2, 3.212e-2}, base_mix(L::one, 1)},
            {"PSSMLT-2", {4.073e-2, 1.488e-2}, base_mix(L::none, 1)},
            {"PSSMLT-AVG", {4.106e-2, 1.587e-2}, average},
            {"PSSMLT-MIX", {3.663e-2, 1.405e-2}, base_mix(L::at_most_one, 2)},
            {"CMLT-IPSM", {3.924e-2, 1.467e-2}, path_space},
            {"CMLT", {3.502e-2, 1.374e-2}, charted}};
}

// Root mean squared error over all values, without the noise of the reference.
//
// The image is scaled to the reference's mean luminance, which is b: what is compared are the chains, not estimates of
// b. (With f / p_1 alone as the target, as PSSMLT-1 has it, such estimates have no finite variance: where light and
// plane meet, f / p_1 grows without bound.)
double rmse(Image image, const Reference& reference) {
    const ErrorMetrics unscaled = compare_images(image, reference.image);
    const auto scale = static_cast<float>(luminance(unscaled.mean_reference) / luminance(unscaled.mean));
    for (float& v : image.rgb) v *= scale;
    const double mse = compare_images(image, reference.image).mse;
    double noise = 0;
    if (reference.variance) {
        for (const float v : reference.variance->rgb) noise += static_cast<double>(v);
        noise /= static_cast<double>(reference.variance->rgb.size());
    }
    return std::sqrt(std::max(0.0, mse - noise));
}

// RMSE by algorithm, number of samples and run.
class Runs {
  public:
    Runs(const Scene& scene, const Reference& reference, const std::vector<Algorithm>& list, int runs,
         const ExperimentOptions& options, const ExperimentCallbacks& callbacks)
        : scene_(scene), reference_(reference), list_(list), runs_(runs), options_(options), callbacks_(callbacks) {
        errors_.resize(list.size());
        for (auto& of_algorithm : errors_)
            for (std::vector<double>& values : of_algorithm) values.resize(static_cast<std::size_t>(runs));
    }

    // Runs are of one or two chains, so several go on at once.
    bool run() {
        const std::size_t jobs = list_.size() * static_cast<std::size_t>(runs_);
        parallel_for(jobs, [&](std::size_t job) {
            if (stopped()) return;
            render_one(job % list_.size(), static_cast<int>(job / list_.size()));
            const std::lock_guard lock(mutex_);
            ++done_;
            if (callbacks_.progress)
                callbacks_.progress({"runs", static_cast<double>(done_) / static_cast<double>(jobs), 0, -1, 0, -1});
        });
        return !stopped();
    }
    const std::vector<double>& errors(std::size_t algorithm, std::size_t size) const {
        return errors_[algorithm][size];
    }

  private:
    bool stopped() const { return callbacks_.stop && callbacks_.stop(); }

    void render_one(std::size_t algorithm, int run) {
        RenderSettings settings;
        settings.mix = list_[algorithm].mix;
        settings.mix.seed = options_.seed + static_cast<std::uint64_t>(run) * list_.size() + algorithm;
        settings.threads = 1;
        const double pixels = static_cast<double>(scene_.film().crop_width) * scene_.film().crop_height;
        settings.mutations_per_pixel = options_.scale * samples[1] / pixels;
        RenderCallbacks callbacks;
        callbacks.stop = [this] { return stopped(); };
        callbacks.checkpoint_shares = {samples[0] / samples[1]};
        callbacks.checkpoint = [&](const Checkpoint& c) { keep(algorithm, 0, run, c.image); };
        const RenderResult result = render(scene_, settings, callbacks);
        keep(algorithm, 1, run, result.image);
    }

    void keep(std::size_t algorithm, std::size_t size, int run, const Image& image) {
        errors_[algorithm][size][static_cast<std::size_t>(run)] = rmse(image, reference_);
        if (run > 0) return;
        const std::string file = fmt::format("{}-{}M", list_[algorithm].name, samples[size] / 1e6);
        for (const char* extension : {".exr", ".png"})
            write_image((std::filesystem::path(options_.folder) / (file + extension)).string(), image);
    }

    const Scene& scene_;
    const Reference& reference_;
    const std::vector<Algorithm>& list_;
    int runs_;
    const ExperimentOptions& options_;
    const ExperimentCallbacks& callbacks_;
    std::vector<std::array<std::vector<double>, 2>> errors_;
    std::mutex mutex_;
    std::size_t done_ = 0;
};

// The algorithms by their mean errors, and whether each is told from the one before it.
std::string order_text(const std::vector<Algorithm>& list, const Runs& runs, std::size_t size) {
    std::vector<std::size_t> order(list.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto mean = [&](std::size_t a) { return estimate_mean(runs.errors(a, size)).mean; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return mean(a) < mean(b); });
    std::string text = list[order[0]].name;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const auto &before = runs.errors(order[i - 1], size), &here = runs.errors(order[i], size);
        const Estimate a = estimate_mean(before), b = estimate_mean(here);
        const bool apart = a.interval && b.interval && a.interval->high < b.interval->low;
        text += fmt::format(" {} {}", apart ? "<" : "~", list[order[i]].name);
    }
    return text;
}

}  // namespace

ExperimentResult run_charted_toy(const ExperimentOptions& options, const ExperimentCallbacks& callbacks) {
    const std::filesystem::path folder(options.folder);
    const int runs = options.runs > 0 ? options.runs : 5;
    const LoadedScene loaded = read_scene((std::filesystem::path(options.scenes) / "charted-toy.xml").string());
    ReferencePlan plan;
    plan.filename = (folder / "reference.exr").string();
    plan.integrator = Integrator::path;
    plan.lengths = {2, 2, false};
    plan.seconds = options.reference_seconds > 0 ? options.reference_seconds : 600;
    plan.threads = options.threads;
    RenderCallbacks of_reference;
    of_reference.progress = callbacks.progress;
    of_reference.stop = callbacks.stop;
    const Reference reference = make_reference(*loaded.scene, plan, of_reference);

    const std::vector<Algorithm> list = algorithms();
    Runs all(*loaded.scene, reference, list, runs, options, callbacks);
    ExperimentResult result;
    result.complete = all.run();
    if (!result.complete) return result;
    result.json = {{"runs", runs},
                   {"scale", options.scale},
                   {"normalisation", "the reference's mean luminance"},
                   {"algorithms", nlohmann::json::array()}};
    PlotPanel panel{"charted-toy", "samples", "RMSE", {}};
    result.text = fmt::format("{:<12}{:>30}{:>30}\n", "RMSE", sample_names[0], sample_names[1]);
    for (std::size_t a = 0; a < list.size(); ++a) {
        nlohmann::json points = nlohmann::json::array();
        PlotSeries series{list[a].name, {}};
        result.text += fmt::format("{:<12}", list[a].name);
        for (std::size_t size = 0; size < 2; ++size) {
            const Estimate e = estimate_mean(all.errors(a, size));
            const Interval interval = e.interval.value_or(Interval{e.mean, e.mean});
            const double n = samples[size] * options.scale;
            series.points.push_back({n, e.mean, interval.low, interval.high});
            points.push_back({{"samples", n},
                              {"rmse", to_json(e)},
                              {"values", all.errors(a, size)},
                              {"published", list[a].published[size]}});
            result.text +=
                fmt::format("{:>30}", fmt::format(" {:.4f} [{:.4f}, {:.4f}]", e.mean, interval.low, interval.high));
        }
        result.text += "\n";
        panel.series.push_back(series);
        result.json["algorithms"].push_back(
            {{"name", list[a].name}, {"mix", write_mix(list[a].mix)}, {"points", points}});
    }
    result.text += "order ('<': 95% intervals apart, '~': they overlap)\n";
    for (std::size_t size = 0; size < 2; ++size) {
        const std::string order = order_text(list, all, size);
        result.text += fmt::format("  {}: {}\n", sample_names[size], order);
        result.json["order"].push_back(order);
    }
    result.text +=
        "published: CMLT, PSSMLT-MIX, CMLT-IPSM, PSSMLT-2, PSSMLT-AVG, PSSMLT-1, of another scene of this "
        "description\n";
    result.svg = svg_plot(fmt::format("charted-toy: means of {} runs, 95% intervals", runs), {panel});
    return result;
}

}  // namespace keyhole
