#include "render/render.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <stdexcept>

#include "base/process.h"
#include "render/metropolis.h"
#include "render/unbiased.h"

namespace keyhole {
namespace {

constexpr int default_max_length = 12, longest_path = 256;
constexpr int default_chains = 1024;
constexpr std::int64_t default_bootstrap_samples = 262144;

void check(bool valid, const char* message) {
    if (!valid) throw std::invalid_argument(message);
}

}  // namespace

RenderSettings resolve(const Scene& scene, RenderSettings s) {
    check(std::isfinite(s.seconds) && std::isfinite(s.mutations_per_pixel) && s.seconds >= 0 &&
              s.mutations_per_pixel >= 0 && (s.seconds > 0) != (s.mutations_per_pixel > 0),
          "give either a time or a number of mutations (samples) per pixel, not both");
    if (s.max_length == 0) s.max_length = scene.max_path_length() > 0 ? scene.max_path_length() : default_max_length;
    check(s.min_length >= 1 && s.max_length >= s.min_length, "path lengths must satisfy 1 <= min <= max");
    check(s.max_length <= longest_path, "paths of more than 256 edges are not supported");
    if (s.chains == 0) s.chains = default_chains;
    if (s.bootstrap_samples == 0) s.bootstrap_samples = default_bootstrap_samples;
    check(s.chains > 0, "the number of chains must be positive");
    check(s.bootstrap_samples >= 4, "the bootstrap needs at least 4 samples");
    const double large = s.large_step_probability, change = s.technique_change_probability;
    check(large > 0 && change >= 0 && large + change <= 1,
          "the probability of a large step must be positive, and with that of a technique change at most 1");
    check(s.kelemen_s1 > 0 && s.kelemen_s2 >= s.kelemen_s1 && s.gaussian_sigma > 0, "step sizes must be positive");
    return s;
}

RenderResult render(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const RenderSettings resolved = resolve(scene, settings);
    const int threads = settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
    // More threads than processors are allowed, as asked for.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    const double cpu_before = cpu_seconds();
    RenderResult result = arena.execute([&] {
        return resolved.integrator == Integrator::mmlt ? render_metropolis(scene, resolved, callbacks)
                                                       : render_unbiased(scene, resolved, callbacks);
    });
    RenderStatistics& s = result.statistics;
    s.cpu_seconds = cpu_seconds() - cpu_before;
    s.peak_memory_bytes = peak_memory_bytes();
    s.threads = threads;
    s.max_length = resolved.max_length;
    if (resolved.integrator == Integrator::mmlt) {
        s.chains = resolved.chains;
    } else {
        double sum = 0;
        for (std::size_t i = 0; i < result.image.rgb.size(); i += 3)
            sum += luminance({result.image.rgb[i], result.image.rgb[i + 1], result.image.rgb[i + 2]});
        s.b = sum / (static_cast<double>(result.image.rgb.size()) / 3);
        if (s.non_finite) s.warnings.push_back("some contributions were NaN or infinite and were left out");
    }
    return result;
}

}  // namespace keyhole
