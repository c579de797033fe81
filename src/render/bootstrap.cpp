#include "render/bootstrap.h"

#include <algorithm>

#include "base/parallel.h"
#include "chain/bootstrap.h"

namespace keyhole {
namespace {

// Share of large steps that is uniform over techniques, so that none is out of reach because a few samples missed it.
constexpr double uniform_share = 0.05;

struct Worker {
    Chart chart;
    PssState state;
    LargeStep large_step;

    Worker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques)
        : chart(scene, layout), state(layout), large_step(chart, techniques) {}
};

using Workers = tbb::enumerable_thread_specific<std::unique_ptr<Worker>>;

template <class Body>
void for_each_sample(std::uint64_t count, const Body& body) {
    constexpr std::uint64_t chunk = 256;
    parallel_for((count + chunk - 1) / chunk, [&](std::uint64_t c) {
        for (std::uint64_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) body(i);
    });
}

// Energies from `samples` large steps that choose techniques uniformly.
void fit_techniques(Workers& workers, TechniqueDistribution& techniques, std::uint64_t samples, std::uint64_t seed) {
    struct Found {
        Technique technique;
        double estimate;
    };
    std::vector<Found> found(samples);
    for_each_sample(samples, [&](std::uint64_t i) {
        Worker& worker = *workers.local();
        Rng rng(seed, stream(StreamUse::energies, i));
        worker.large_step.draw(worker.state, rng);
        found[i] = {{worker.state.u.k, worker.state.u.t}, worker.large_step.estimate(worker.state)};
    });
    std::vector<double> energies(techniques.techniques().size(), 0.0);
    for (const Found& f : found) energies[techniques.index(f.technique.k, f.technique.t)] += f.estimate;
    techniques.fit(energies, uniform_share);
}

}  // namespace

Bootstrap run_bootstrap(const Scene& scene, const CoordinateLayout& layout, TechniqueDistribution& techniques,
                        std::uint64_t samples, std::size_t chains, std::uint64_t seed) {
    Bootstrap result;
    Workers workers([&] { return std::make_unique<Worker>(scene, layout, techniques); });
    fit_techniques(workers, techniques, samples / 4, seed);

    std::vector<double> weights(samples - samples / 4);
    std::vector<std::uint8_t> finite(weights.size(), 1);
    const auto draw = [&](Worker& worker, std::uint64_t i) {
        Rng rng(seed, stream(StreamUse::seeds, i));
        return worker.large_step.draw(worker.state, rng);
    };
    for_each_sample(weights.size(), [&](std::uint64_t i) {
        Worker& worker = *workers.local();
        finite[i] = draw(worker, i) != PathFailure::non_finite;
        weights[i] = worker.large_step.estimate(worker.state);
    });
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        result.b.add(weights[i]);
        result.non_finite += !finite[i];
        sum += weights[i];
    }
    for (const auto& worker : workers) result.rays += worker->chart.tracer().rays();
    if (!(sum > 0)) return result;

    Rng rng(seed, stream(StreamUse::resampling, 0));
    Worker& worker = *workers.local();
    for (const std::size_t i : resample(weights, chains, rng.uniform())) {
        draw(worker, i);
        result.seeds.push_back(worker.state);
    }
    return result;
}

}  // namespace keyhole
