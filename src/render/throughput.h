// How fast the chains run, and how much of the time is Embree's.
//
// Everything is measured in alternating slices within one run, since machines are noisy: the same mutations are timed,
// made again with their rays recorded, and the rays replayed through Embree alone by the same threads. The replay ratio
// is the replay's time over the mutations' time.
#pragma once

#include "chain/running_mean.h"
#include "render/render.h"

namespace keyhole {

struct Throughput {
    RunningMean mutations_per_cpu_second;  // one value per slice; processor time of all threads
    RunningMean mutations_per_second;      // wall clock
    RunningMean replay_ratio;              // processor time
    RunningMean replayed_rays_per_cpu_second;
    double rays_per_mutation = 0, mean_acceptance = 0;
    int threads = 1;
};

// Runs MMLT slices with `threads` threads for about `seconds`. The film is written but not kept. Throws
// std::invalid_argument as render() does, and std::runtime_error if the scene is black.
Throughput measure_throughput(const Scene& scene, const RenderSettings& settings, int threads, double seconds);

}  // namespace keyhole
