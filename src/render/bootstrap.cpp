#include "render/bootstrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/parallel.h"
#include "chain/bootstrap.h"

namespace keyhole {
namespace {

// Share of large steps that chooses techniques by their prior, so that none is out of reach because the samples that
// the fit is made from missed it.
constexpr double prior_share = 0.05;

struct Worker {
    std::unique_ptr<Evaluator> evaluator;
    PssState state;
    LargeStep large_step;

    Worker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques, const Mix& mix)
        : evaluator(make_evaluator(scene, layout, mix)),
          state(evaluator->make_state()),
          large_step(*evaluator, techniques, mix.lengths.fixed) {}
};

using Workers = tbb::enumerable_thread_specific<std::unique_ptr<Worker>>;

template <class Body>
void for_each_sample(std::uint64_t count, const Body& body) {
    constexpr std::uint64_t chunk = 256;
    parallel_for((count + chunk - 1) / chunk, [&](std::uint64_t c) {
        for (std::uint64_t i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) body(i);
    });
}

// Energies from `samples` large steps that choose techniques by their prior.
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
        const int k = worker.state.u.k, t = worker.state.u.t;
        found[i] = {{k, t}, worker.state.target / techniques.probability(k, t)};
    });
    std::vector<double> energies(techniques.techniques().size(), 0.0);
    for (const Found& f : found) energies[techniques.index(f.technique.k, f.technique.t)] += f.estimate;
    techniques.fit(energies, prior_share);
}

std::size_t replicate_of(std::size_t sample, std::size_t samples, std::size_t replicates) {
    return sample * replicates / samples;
}

// No sample counts for more than that many of mean weight: a hundredth of those in a usual bootstrap. Where the chains
// are slow, far fewer would leave too much to them.
constexpr double most_of_sample = 2000;

// From the samples of each length (of all, where `lengths` holds zeros): given its length, a sample estimates b of that
// length. Without the groups that found nothing.
std::vector<ChainGroup> make_groups(const std::vector<double>& weights, const std::vector<std::uint16_t>& lengths,
                                    const PathLengths& range, std::size_t replicates) {
    std::vector<ChainGroup> groups(range.fixed ? range.max + 1 : 1);
    std::vector<std::vector<double>> own(groups.size());
    for (std::size_t i = 0; i < weights.size(); ++i) own[lengths[i]].push_back(weights[i]);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        groups[g].length = static_cast<int>(g);
        groups[g].b.resize(replicates);
        groups[g].bridge = bridge_for(own[g], most_of_sample);
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        ChainGroup& group = groups[lengths[i]];
        group.b[replicate_of(i, weights.size(), replicates)].add_sample(weights[i], group.bridge);
        group.largest.add(weights[i]);
    }
    std::erase_if(groups, [](const ChainGroup& group) { return !(group.all().b() > 0); });
    return groups;
}

// How many of the chains each group gets: one for sure, the others in proportion to its b. Any such numbers give the
// right image; these give splats of nearly equal weight.
std::vector<std::size_t> share_chains(const std::vector<ChainGroup>& groups, std::size_t chains) {
    if (chains < groups.size())
        throw std::invalid_argument(
            fmt::format("{} chains of fixed length are too few: paths of {} lengths carry light, and "
                        "each needs a chain",
                        chains, groups.size()));
    std::vector<std::size_t> counts(groups.size(), 1);
    if (groups.empty()) return counts;
    std::vector<double> shares;
    for (const ChainGroup& group : groups) shares.push_back(group.all().b());
    for (const std::size_t g : resample(shares, chains - groups.size(), 0.5)) ++counts[g];
    return counts;
}

}  // namespace

Normalization ChainGroup::all() const {
    Normalization all;
    for (const Normalization& replicate : b) all.merge(replicate);
    return all;
}

Bootstrap run_bootstrap(const Scene& scene, const CoordinateLayout& layout, TechniqueDistribution& techniques,
                        const Mix& mix) {
    const auto samples = static_cast<std::uint64_t>(mix.bootstrap_samples);
    Bootstrap result;
    Workers workers([&] { return std::make_unique<Worker>(scene, layout, techniques, mix); });
    fit_techniques(workers, techniques, samples / 4, mix.seed);

    std::vector<double> weights(samples - samples / 4);
    std::vector<std::uint8_t> finite(weights.size(), 1);
    std::vector<std::uint16_t> lengths(weights.size());
    const auto draw = [&](Worker& worker, std::uint64_t i) {
        Rng rng(mix.seed, stream(StreamUse::seeds, i));
        return worker.large_step.draw(worker.state, rng);
    };
    for_each_sample(weights.size(), [&](std::uint64_t i) {
        Worker& worker = *workers.local();
        finite[i] = draw(worker, i) != PathFailure::non_finite;
        weights[i] = worker.large_step.estimate(worker.state);
        lengths[i] = static_cast<std::uint16_t>(mix.lengths.fixed ? worker.state.u.k : 0);
    });
    for (const std::uint8_t f : finite) result.non_finite += !f;
    for (const auto& worker : workers) result.rays += worker->evaluator->tracer().rays();

    const std::size_t replicates = replicate_count(mix);
    result.groups = make_groups(weights, lengths, mix.lengths, replicates);
    const std::vector<std::size_t> counts = share_chains(result.groups, static_cast<std::size_t>(mix.chain_count));
    Rng rng(mix.seed, stream(StreamUse::resampling, 0));
    Worker& worker = *workers.local();
    for (std::size_t g = 0; g < counts.size(); ++g) {
        ChainGroup& group = result.groups[g];
        std::vector<double> own = weights;
        for (std::size_t i = 0; i < own.size(); ++i)
            if (lengths[i] != group.length) own[i] = 0;
        const std::vector<double> bounded = bounded_shares(own, mix.most_starts);
        group.moved_starts = moved_share(own, bounded);
        for (const std::size_t i : resample(bounded, counts[g], rng.uniform())) {
            draw(worker, i);
            const auto replicate = static_cast<std::uint32_t>(replicate_of(i, own.size(), replicates));
            group.seeds.push_back({worker.state, replicate});
        }
    }
    return result;
}

}  // namespace keyhole
