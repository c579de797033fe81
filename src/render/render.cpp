#include "render/render.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/phase.h"
#include "base/process.h"
#include "base/units.h"
#include "pss/layout.h"
#include "render/bootstrap.h"
#include "render/film.h"
#include "render/metropolis.h"
#include "render/unbiased.h"

namespace keyhole {
namespace {

constexpr int default_max_length = 12;
constexpr int default_chains = 256;  // more have more start-up error in short renders (docs/benchmarks.md)
constexpr std::int64_t default_bootstrap_samples = 262144;

void check(bool valid, const char* message) {
    if (!valid) throw std::invalid_argument(message);
}

// Refuses what surely does not fit: the system would end the program while it fills its memory, without a word.
void check_memory(const Scene& scene, const RenderSettings& s, int threads) {
    const bool chains = s.integrator == Integrator::mmlt;
    const double pixels = static_cast<double>(scene.film().crop_width) * scene.film().crop_height;
    const std::size_t film = chains ? MetropolisFilm::bytes_per_pixel : RadianceFilm::bytes_per_pixel;
    const std::size_t groups = s.mix.lengths.fixed ? static_cast<std::size_t>(s.mix.lengths.max) : 1;
    const double of_replicates = s.error_image ? static_cast<double>(groups * replicate_count(s.mix)) : 0;
    const double films = pixels * static_cast<double>(film) * (threads + of_replicates);
    const CoordinateLayout layout(scene, s.mix.lengths.max);
    const auto per_state = static_cast<double>(bytes_per_state(layout, s.mix));
    const double states = chains ? 2.0 * s.mix.chain_count * per_state : 0;
    const std::uint64_t memory = physical_memory_bytes();
    if (memory == 0 || films + states <= static_cast<double>(memory)) return;
    const auto bytes = [](double b) { return format_bytes(static_cast<std::uint64_t>(std::min(b, 1e19))); };
    throw std::runtime_error(
        fmt::format("too little memory: the films of {} threads take {} and the chains {}; this "
                    "machine has {}",
                    threads, bytes(films), bytes(states), format_bytes(memory)));
}

}  // namespace

const char* integrator_name(Integrator integrator) {
    switch (integrator) {
        case Integrator::path:
            return "path";
        case Integrator::bdpt:
            return "bdpt";
        case Integrator::mmlt:
            break;
    }
    return "mmlt";
}

RenderSettings resolve(const Scene& scene, RenderSettings s) {
    const bool chains = s.integrator == Integrator::mmlt;
    int limits = 0;
    for (const double limit : {s.seconds, s.cpu_seconds, s.mutations_per_pixel}) {
        check(std::isfinite(limit) && limit >= 0, "the length of a render must be finite and not negative");
        limits += limit > 0;
    }
    check(limits <= 1, "give either a time or a number of mutations (samples) per pixel, not both");
    check(limits == 1 || (chains && s.mix.chain_length > 0),
          "neither a time nor a number of mutations (samples) per pixel is given");
    Mix& mix = s.mix;
    if (mix.lengths.max == 0)
        mix.lengths.max = scene.max_path_length() > 0 ? scene.max_path_length() : default_max_length;
    if (mix.chain_count == 0) mix.chain_count = default_chains;
    if (mix.bootstrap_samples == 0) mix.bootstrap_samples = default_bootstrap_samples;
    check(mix.lengths.min >= 1 && mix.lengths.max >= mix.lengths.min, "path lengths must satisfy 1 <= min <= max");
    check(mix.lengths.max <= PathLengths::longest, "paths of more than 256 edges are not supported");
    check(mix.chain_count > 0, "the number of chains must be positive");
    check(mix.bootstrap_samples >= 4, "the bootstrap needs at least 4 samples");
    check(!chains || mix.lengths.max > 1 || mix.techniques.light_vertices != LightVertices::one,
          "paths of one edge have no technique with one vertex from the light");
    check(chains || !s.error_image, "errors of pixels are estimated with chains only");
    if (!chains) return s;
    Mix applicable = mix;
    std::erase_if(applicable.strategies,
                  [&](const MixStrategy& m) { return !m.info->hindrance(scene, mix.lengths).empty(); });
    if (const auto wrong = contradiction(applicable)) throw std::invalid_argument(wrong->message);
    const FilmSettings& film = scene.film();
    const double pixels = static_cast<double>(film.crop_width) * film.crop_height;
    if (s.seconds > 0 || s.cpu_seconds > 0) mix.chain_length = 0;
    if (s.mutations_per_pixel > 0)
        mix.chain_length =
            static_cast<std::int64_t>(std::min(9e18, std::ceil(s.mutations_per_pixel * pixels / mix.chain_count)));
    return s;
}

namespace {

std::map<std::string, double> shares(const PhaseSampler::Counts& counts) {
    double all = 0;
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (static_cast<Phase>(i) != Phase::idle) all += static_cast<double>(counts[i]);
    std::map<std::string, double> result;
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (static_cast<Phase>(i) != Phase::idle && all > 0)
            result[phase_names[i]] = static_cast<double>(counts[i]) / all;
    return result;
}

}  // namespace

RenderResult render(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const RenderSettings resolved = resolve(scene, settings);
    const int threads = settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
    check_memory(scene, resolved, threads);
    // More threads than processors are allowed, as asked for.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    std::optional<PhaseSampler> phases;
    if (settings.sample_time_split) phases.emplace();
    RenderResult result = arena.execute([&] {
        return resolved.integrator == Integrator::mmlt ? render_metropolis(scene, resolved, callbacks)
                                                       : render_unbiased(scene, resolved, callbacks);
    });
    RenderStatistics& s = result.statistics;
    if (phases) s.time_split = shares(phases->counts());
    s.peak_memory_bytes = peak_memory_bytes();
    s.threads = threads;
    s.max_length = resolved.mix.lengths.max;
    if (resolved.integrator == Integrator::mmlt) {
        s.chains = resolved.mix.chain_count;
    } else {
        double sum = 0;
        for (std::size_t i = 0; i < result.image.rgb.size(); i += 3)
            sum += luminance({result.image.rgb[i], result.image.rgb[i + 1], result.image.rgb[i + 2]});
        s.b = sum / (static_cast<double>(result.image.rgb.size()) / 3);
        s.b_standard_error = std::numeric_limits<double>::infinity();  // not known
        if (s.non_finite) s.warnings.push_back("some contributions were NaN or infinite and were left out");
    }
    return result;
}

}  // namespace keyhole
