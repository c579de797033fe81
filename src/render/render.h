// Renders a scene: the one entry point of the command, the tests and the comparisons.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chain/mixing.h"
#include "render/image.h"
#include "scene/scene.h"
#include "strategies/mix_file.h"

namespace keyhole {

enum class Integrator { path, bdpt, mmlt };
const char* integrator_name(Integrator integrator);

struct RenderSettings {
    Integrator integrator = Integrator::mmlt;
    // How long: at most one of the three is positive. Wall-clock time; processor time of all threads; or mutations
    // (mmlt) or samples (path, bdpt) per pixel of the crop window: a run of a given count is repeatable bit for bit
    // with any number of threads. All 0: mutations of each chain as the mix says.
    double seconds = 0;
    double cpu_seconds = 0;
    double mutations_per_pixel = 0;
    // How the chains of mmlt move. For path and bdpt: the seed and the lengths of paths.
    Mix mix = builtin_mix("mmlt");
    int threads = 0;  // 0: all
    // Seconds between previews; 0: none.
    double preview_every = 0;
    // Fill in RenderStatistics::time_split, for less than 2% of the time.
    bool sample_time_split = false;
    // Whether standard errors of pixels are estimated (mmlt only): one film for each replicate of the run.
    bool error_image = false;
};

struct Progress {
    std::string phase;  // "bootstrap", "render"
    double fraction = 0;
    double elapsed = 0, remaining = 0;  // seconds; remaining < 0: not known yet
    double rate = 0;                    // mutations or samples per second
    double acceptance = -1;             // of all strategies; < 0: does not apply
};

// A render after a part of its length. Times are from its start, bootstrap included.
struct Checkpoint {
    double share = 0;  // the largest of RenderCallbacks::checkpoint_shares that was reached
    double seconds = 0, cpu_seconds = 0;
    std::uint64_t mutations = 0;  // or samples
    Image image;
};

struct RenderCallbacks {
    std::function<void(const Progress&)> progress;
    std::function<void(const Image&)> preview;
    std::function<bool()> stop;  // true: finish the current pass and return
    // Called once for each of the shares (ascending, below 1) of the render's length, as soon as a pass has reached it;
    // not for a share that is reached in the same pass as the next one, nor for one within the last pass. The time that
    // the call takes does not count.
    std::vector<double> checkpoint_shares;
    std::function<void(Checkpoint)> checkpoint;
};

struct StrategyStatistics {
    std::string name;  // its label in the mix
    std::uint64_t proposals = 0, accepted = 0;
    double mean_acceptance = 0;
    std::map<std::string, std::uint64_t> failures;  // by kind; of first stages, where a second one follows
    std::uint64_t excluded = 0;                     // of the proposals: failures that did not count as steps
    // Second stages, after first ones that failed: how many there were, and what became of them.
    struct SecondStage {
        std::uint64_t proposals = 0, accepted = 0;
        std::map<std::string, std::uint64_t> failures;
    } second;
    // What its proposals are worth by themselves, at most (see mixing_bound): of the luminance that a path carries (the
    // logarithm of the target C), and of its position in the image.
    Mixing luminance, position;
};

// Of chains that keep their length: all with the same one.
struct LengthStatistics {
    int length = 0;  // edges
    std::uint64_t chains = 0;
    double b = 0, b_standard_error = 0;  // what paths of this length add to `b`
};

// How far to trust a run of chains, from the disagreement of independent replicates of it. What is not known (there was
// one chain, or nothing to see) is infinite, or negative where it is said.
struct ErrorStatistics {
    int replicates = 0;
    double image_mean = 0;  // standard error of the image's mean luminance
    // 16 x 16 equal blocks of the image, row by row from the top: mean luminance, and its standard error.
    std::vector<double> block_means, block_errors;
    double blocks_relative = 0;  // mean of block_errors over the image's mean
    // Of all chains together: of the luminance that a path carries and of its position in the image.
    Mixing luminance, position;
    // Share of the light in blocks where replicates disagree more than their own noise explains; negative: the run was
    // too short to know.
    double disagreeing_light = -1;
    // Of all independent samples: how many of equal weight would have as small an error of their mean, and what share
    // of their sum the five largest have.
    double effective_paths = 0, heaviest_share = 0;
    double moved_starts = 0;  // share of the light whose chains start elsewhere (Mix::most_starts): a bias of the start
};

// What Mix::Tuning::race saw: the winner of the sets and the others, from the best on, then the same of its neighbours.
struct TuningStatistics {
    struct Contender {
        std::string name;
        double mutations = 0, cpu_seconds = 0;
        double error = 0;  // root mean square of the relative errors of the race's cells, after that
    };
    std::vector<Contender> contenders;
    std::string winner;
    bool clear = false;  // false: the race was too short to tell, and the winner is what such races end with
    double mutations = 0, cpu_seconds = 0;  // of all
};

struct RenderStatistics {
    std::optional<TuningStatistics> tuning;
    Mix mix;                      // as it was used, after tuning
    std::uint64_t mutations = 0;  // or samples
    std::uint64_t rounds = 0;     // mutations of each chain, or samples of each pixel that the filter reaches
    std::uint64_t rays = 0;
    double seconds_bootstrap = 0, seconds_render = 0, cpu_seconds = 0;  // the first with tuning
    // Integral of f* over the area of the crop window: the mean luminance of the image, where the mix does not say
    // another target. By bridge sampling (chain/normalization.h); its error by the replicates, infinite if there is
    // one.
    double b = 0, b_standard_error = 0;
    int chains = 0, threads = 0, max_length = 0;
    std::vector<StrategyStatistics> strategies;
    ErrorStatistics errors;                 // of chains
    std::vector<LengthStatistics> lengths;  // of chains that keep theirs; in ascending order
    std::uint64_t non_finite = 0;           // NaN or infinite contributions: rejected, counted, and warned about
    std::uint64_t peak_memory_bytes = 0;
    bool interrupted = false;
    // Shares of the threads' time by phase_names (base/phase.h), sampled every two milliseconds; without idle time.
    std::map<std::string, double> time_split;
    std::vector<std::string> warnings;
};

struct RenderResult {
    Image image;  // of the crop window
    Image error;  // standard errors of its values, where the settings ask for them; infinite where not known
    RenderStatistics statistics;
};

// The settings with everything that was left to default filled in from the scene: of the mix, the lengths, the number
// of chains and bootstrap samples, and the chains' length unless the run is limited by time. Throws
// std::invalid_argument for settings that make no sense together.
RenderSettings resolve(const Scene& scene, RenderSettings settings);

// Throws as resolve() does.
RenderResult render(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks = {});

}  // namespace keyhole
