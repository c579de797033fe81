// Renders a scene: the one entry point of the command, the tests and the comparisons.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/image.h"
#include "scene/scene.h"

namespace keyhole {

enum class Integrator { path, bdpt, mmlt };
enum class StepKernel { kelemen, gaussian };

struct RenderSettings {
    Integrator integrator = Integrator::mmlt;
    // How long: exactly one of the two is positive. Mutations (mmlt) or samples (path, bdpt) per pixel of the crop
    // window; a run of a given count is repeatable bit for bit with any number of threads.
    double seconds = 0;
    double mutations_per_pixel = 0;
    int min_length = 1, max_length = 0;  // edges of a path; max 0: what the scene file says, else 12
    int chains = 0;                      // 0: default
    std::uint64_t seed = 0;
    int threads = 0;  // 0: all
    // mmlt
    std::int64_t bootstrap_samples = 0;  // 0: default
    double large_step_probability = 0.1;
    double technique_change_probability = 0.05;
    StepKernel kernel = StepKernel::kelemen;
    double kelemen_s1 = 1.0 / 1024, kelemen_s2 = 1.0 / 64;
    double gaussian_sigma = 0.01;
    // Seconds between previews; 0: none.
    double preview_every = 0;
};

struct Progress {
    std::string phase;  // "bootstrap", "render"
    double fraction = 0;
    double elapsed = 0, remaining = 0;  // seconds; remaining < 0: not known yet
    double rate = 0;                    // mutations or samples per second
    double acceptance = -1;             // of all strategies; < 0: does not apply
};

struct RenderCallbacks {
    std::function<void(const Progress&)> progress;
    std::function<void(const Image&)> preview;
    std::function<bool()> stop;  // true: finish the current pass and return
};

struct StrategyStatistics {
    std::string name;
    std::uint64_t proposals = 0, accepted = 0;
    double mean_acceptance = 0;
    std::map<std::string, std::uint64_t> failures;  // by kind
};

struct RenderStatistics {
    std::uint64_t mutations = 0;  // or samples
    std::uint64_t rays = 0;
    double seconds_bootstrap = 0, seconds_render = 0, cpu_seconds = 0;
    double b = 0, b_standard_error = 0;  // mean luminance of the crop window's pixels, and the error of that estimate
    int chains = 0, threads = 0, max_length = 0;
    std::vector<StrategyStatistics> strategies;
    std::uint64_t non_finite = 0;  // NaN or infinite contributions: rejected, counted, and warned about
    std::uint64_t peak_memory_bytes = 0;
    bool interrupted = false;
    std::vector<std::string> warnings;
};

struct RenderResult {
    Image image;  // of the crop window
    RenderStatistics statistics;
};

// The settings with everything that was left to default filled in from the scene. Throws std::invalid_argument for
// settings that make no sense together.
RenderSettings resolve(const Scene& scene, RenderSettings settings);

// Throws as resolve() does.
RenderResult render(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks = {});

}  // namespace keyhole
