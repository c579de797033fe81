#include "compare/reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "base/vec.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* metadata_key = "keyhole:reference";
constexpr double least_batches = 64;  // in the whole time, so that the variance is known to a fifth
constexpr double seconds_between_files = 30;

std::string variance_filename(const std::string& filename) {
    const fs::path path(filename);
    return (path.parent_path() / (path.stem().string() + "-variance.exr")).string();
}

json read_description(const std::string& filename) {
    const std::string text = read_metadata(filename, metadata_key);
    return text.empty() ? json() : json::parse(text);
}

// Mean and variance of the batches' images, and how they were made.
class Batches {
  public:
    Batches(const Scene& scene, const ReferencePlan& plan) : scene_(scene), plan_(plan) {
        identity_ = {{"scene", hash_text(scene.content_hash())},
                     {"integrator", integrator_name(plan.integrator)},
                     {"lengths", {plan.lengths.min, plan.lengths.max}},
                     {"seed", plan.seed}};
        if (fs::exists(plan.filename)) load();
    }

    double seconds() const { return seconds_; }

    void make_one(const RenderCallbacks& callbacks) {
        if (samples_ == 0) samples_ = measure_samples(callbacks);
        const RenderResult result = render(samples_, 1 + count_, callbacks);
        if (result.statistics.interrupted) return;
        seconds_ += result.statistics.seconds_render;
        add(result.image);
    }

    Reference result() const {
        const FilmSettings& film = scene_.film();
        Reference r;
        r.image = Image(film.crop_width, film.crop_height);
        r.variance = Image(film.crop_width, film.crop_height);
        const double n = static_cast<double>(count_);
        for (std::size_t i = 0; i < mean_.size(); ++i) {
            r.image.rgb[i] = static_cast<float>(mean_[i]);
            r.variance->rgb[i] = static_cast<float>(count_ > 1 ? squares_[i] / (n * (n - 1)) : 0);
        }
        if (count_ < 2) r.variance.reset();
        r.filename = plan_.filename;
        r.integrator = integrator_name(plan_.integrator);
        r.samples_per_pixel = samples_ * count_;
        r.seconds = seconds_;
        return r;
    }

    // The variance first: a mean without it is not taken for a reference that can be continued.
    void write() const {
        if (count_ < 2) return;
        const Reference r = result();
        json description = identity_;
        description["batches"] = count_;
        description["samples_per_batch"] = samples_;
        description["samples_per_pixel"] = r.samples_per_pixel;
        description["seconds"] = seconds_;
        WriteOptions options;
        options.metadata[metadata_key] = description.dump();
        write_image(variance_filename(plan_.filename), *r.variance, options);
        write_image(plan_.filename, r.image, options);
    }

  private:
    RenderResult render(std::uint64_t samples, std::uint64_t number, const RenderCallbacks& callbacks) const {
        RenderSettings settings;
        settings.integrator = plan_.integrator;
        settings.mutations_per_pixel = static_cast<double>(samples);
        settings.threads = plan_.threads;
        settings.mix.lengths = plan_.lengths;
        Hash hash;
        hash.add(plan_.seed);
        hash.add(number);
        settings.mix.seed = hash.value() >> 1;
        return keyhole::render(scene_, settings, callbacks);
    }

    // Per pixel and batch.
    std::uint64_t measure_samples(const RenderCallbacks& callbacks) const {
        const double seconds_of_one = render(1, 0, callbacks).statistics.seconds_render;
        return static_cast<std::uint64_t>(
            std::max(1.0, plan_.seconds / least_batches / std::max(1e-6, seconds_of_one)));
    }

    void add(const Image& image) {
        mean_.resize(image.rgb.size(), 0.0);
        squares_.resize(image.rgb.size(), 0.0);
        const double n = static_cast<double>(++count_);
        for (std::size_t i = 0; i < mean_.size(); ++i) {
            const double delta = image.rgb[i] - mean_[i];
            mean_[i] += delta / n;
            squares_[i] += delta * (image.rgb[i] - mean_[i]);
        }
    }

    void load() {
        const json there = read_description(plan_.filename);
        for (const auto& [key, value] : identity_.items())
            if (there.is_null() || there.at(key) != value)
                throw InputError({plan_.filename},
                                 "is not a reference of this scene and these settings (" +
                                     (there.is_null() ? "it does not say how it was made"
                                                      : key + " " + there.at(key).dump() + ", wanted " + value.dump()) +
                                     "); give another folder, or delete it");
        const std::string variance_file = variance_filename(plan_.filename);
        if (read_description(variance_file) != there)
            throw InputError({variance_file}, "does not belong to '" + plan_.filename + "'; delete both to start anew");
        count_ = there.at("batches");
        samples_ = there.at("samples_per_batch");
        seconds_ = there.at("seconds");
        const Image mean = read_image(plan_.filename), variance = read_image(variance_file);
        mean_.assign(mean.rgb.begin(), mean.rgb.end());
        const double n = static_cast<double>(count_);
        for (const float v : variance.rgb) squares_.push_back(v * n * (n - 1));
    }

    const Scene& scene_;
    const ReferencePlan& plan_;
    json identity_;
    std::uint64_t count_ = 0, samples_ = 0;
    double seconds_ = 0;
    std::vector<double> mean_, squares_;  // Welford's sums
};

}  // namespace

Reference read_reference(const std::string& filename) {
    Reference r;
    r.filename = filename;
    r.image = read_image(filename);
    const json description = read_description(filename);
    if (description.is_null()) return r;
    r.integrator = description.value("integrator", "");
    r.samples_per_pixel = description.value("samples_per_pixel", std::uint64_t{0});
    r.seconds = description.value("seconds", 0.0);
    const std::string variance = variance_filename(filename);
    if (fs::exists(variance) && read_description(variance) == description) r.variance = read_image(variance);
    return r;
}

Reference make_reference(const Scene& scene, const ReferencePlan& plan, const RenderCallbacks& callbacks) {
    using Clock = std::chrono::steady_clock;
    Batches batches(scene, plan);
    RenderCallbacks of_batch;
    of_batch.stop = callbacks.stop;
    auto written = Clock::now();
    const auto stopped = [&] { return callbacks.stop && callbacks.stop(); };
    while (batches.seconds() < plan.seconds && !stopped()) {
        batches.make_one(of_batch);
        if (callbacks.progress) {
            Progress p;
            p.phase = "reference";
            p.elapsed = batches.seconds();
            p.fraction = std::min(1.0, batches.seconds() / plan.seconds);
            p.remaining = std::max(0.0, plan.seconds - batches.seconds());
            callbacks.progress(p);
        }
        if (std::chrono::duration<double>(Clock::now() - written).count() < seconds_between_files) continue;
        batches.write();
        written = Clock::now();
    }
    batches.write();
    return batches.result();
}

}  // namespace keyhole
