#include "render/chain_run.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace keyhole {
namespace {

std::map<std::string, std::uint64_t> failures_by_name(const StageCounts& counts) {
    std::map<std::string, std::uint64_t> failures;
    for (std::size_t kind = 1; kind < failure_kinds; ++kind)
        if (counts.failures[kind]) failures[std::string(failure_names[kind])] = counts.failures[kind];
    return failures;
}

void report_strategy(const std::string& name, const StrategyCounts& counts, RenderStatistics& statistics) {
    StrategyStatistics s;
    s.name = name;
    s.proposals = counts.proposals;
    s.accepted = counts.accepted;
    s.mean_acceptance = counts.mean_acceptance();
    s.failures = failures_by_name(counts);
    s.excluded = counts.excluded;
    s.second = {counts.second.proposals, counts.second.accepted, failures_by_name(counts.second)};
    statistics.strategies.push_back(std::move(s));
    const auto non_finite = counts.failed(Failure::non_finite) + counts.second.failed(Failure::non_finite);
    statistics.non_finite += non_finite;
    if (non_finite)
        statistics.warnings.push_back(
            fmt::format("{} proposals of '{}' were NaN or infinite and were rejected", non_finite, name));
}

}  // namespace

ChainRun::ChainRun(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
                   const TechniqueDistribution& techniques, Bootstrap bootstrap, const Recording& recording)
    : scene_(scene),
      groups_(std::move(bootstrap.groups)),
      chains_(start_chains(groups_, settings.mix.seed)),
      chain_counts_(cells<double>()),
      grid_(RasterWindow(scene.film()), recording.block_side),
      blocks_(groups_.size(), replicates(), grid_.count()),
      workers_([&, recording, this] {
          return std::make_unique<ChainWorker>(scene, layout, techniques, settings.mix, groups_.size(),
                                               settings.error_image ? &replicate_films_ : nullptr, recording);
      }) {
    for (const RunningChain& c : chains_) ++chain_counts_[c.group][c.replicate];
    if (settings.mix.exchange_every > 0)
        exchanges_.emplace(static_cast<std::uint64_t>(settings.mix.exchange_every), settings.mix.seed, chains_);
    if (settings.error_image) replicate_films_ = cells(SharedMetropolisFilm(scene.film()));
}

std::uint64_t ChainRun::advance(std::uint64_t most) {
    const std::uint64_t mutations = std::min(most, blocks_.left_of_batch());
    for (std::uint64_t left = mutations; left > 0;) {
        const std::uint64_t n = exchanges_ ? std::min(left, exchanges_->left_of_round()) : left;
        parallel_for(chains_.size(), [&](std::uint64_t i) { workers_.local()->advance(chains_[i], n); });
        left -= n;
        if (exchanges_) exchanges_->passed(n, chains_, [&] { return workers_.local().get(); });
    }
    for (const auto& worker : workers_) blocks_.take(worker->blocks);
    blocks_.passed(mutations);
    done_ += mutations;
    return mutations;
}

Diagnostics ChainRun::diagnostics() const {
    Diagnostics total((*workers_.begin())->mixture.size());
    for (const auto& worker : workers_) total += worker->diagnostics;
    return total;
}

std::uint64_t ChainRun::rays() const {
    std::uint64_t rays = 0;
    for (const auto& worker : workers_) rays += worker->evaluator->tracer().rays();
    return rays;
}

template <class Sink>
void ChainRun::splat_held(Sink& sink, std::size_t group, std::size_t replicate) const {
    for (const RunningChain& c : chains_)
        if (c.group == group && (replicate == every || c.replicate == replicate)) c.chain.splat_held(sink);
}

Image ChainRun::develop() const {
    const ReplicateErrors errors(estimate_b(), mutations());
    Image image(scene_.film().crop_width, scene_.film().crop_height);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        MetropolisFilm sum(scene_.film());
        for (const auto& worker : workers_)
            if (!worker->films.empty()) sum.merge(worker->films[g]);
        if (!replicate_films_.empty())
            for (const SharedMetropolisFilm& film : replicate_films_[g]) sum.merge(film);
        FilmSink sink{sum};
        splat_held(sink, g);
        const Image part = sum.develop(errors.b(g) / errors.mutations(g));
        for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] += part.rgb[i];
    }
    return image;
}

Image ChainRun::develop_errors() const {
    const ReplicateErrors errors(estimate_b(), mutations());
    const auto part = [&](std::size_t g, std::size_t r) {
        MetropolisFilm sum(scene_.film());
        sum.merge(replicate_films_[g][r]);
        FilmSink sink{sum};
        splat_held(sink, g, r);
        return sum.develop(errors.b(g) / errors.mutations(g)).rgb;
    };
    Image image(scene_.film().crop_width, scene_.film().crop_height);
    const std::vector<double> values = errors.standard_errors(image.rgb.size(), part);
    for (std::size_t i = 0; i < values.size(); ++i) image.rgb[i] = static_cast<float>(values[i]);
    return image;
}

void ChainRun::report(const std::vector<const MixStrategy*>& strategies, RenderStatistics& statistics) const {
    statistics.rays += rays();
    report_b(statistics);
    const Diagnostics total = diagnostics();
    for (std::size_t i = 0; i < strategies.size(); ++i)
        report_strategy(strategies[i]->label, total.strategies[i], statistics);
    report_errors(record(), blocks_, statistics);
    if (exchanges_) {
        StrategyCounts exchanges;
        for (const auto& worker : workers_) exchanges += worker->exchanges;
        report_strategy("exchange", exchanges, statistics);
    }
}

ChainRun::Cells<Normalization> ChainRun::estimate_b() const {
    Cells<Normalization> b;
    for (const ChainGroup& group : groups_) b.push_back(group.b);
    for (const RunningChain& c : chains_) b[c.group][c.replicate].merge(c.b);
    return b;
}

ChainRun::Cells<double> ChainRun::mutations() const {
    Cells<double> result = chain_counts_;
    for (std::vector<double>& group : result)
        for (double& count : group) count *= static_cast<double>(done_);
    return result;
}

double ChainRun::chains_of(std::size_t group) const {
    return std::accumulate(chain_counts_[group].begin(), chain_counts_[group].end(), 0.0);
}

void ChainRun::report_b(RenderStatistics& statistics) const {
    const double area = RasterWindow(scene_.film()).area();
    const ReplicateErrors errors(estimate_b(), mutations());
    double variance = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const auto chains = static_cast<std::uint64_t>(chains_of(g));
        const LengthStatistics s{groups_[g].length, chains, errors.b(g) / area, errors.error_of_b(g) / area};
        statistics.b += s.b;
        statistics.errors.moved_starts += groups_[g].moved_starts * s.b;
        variance += s.b_standard_error * s.b_standard_error;
        if (s.length > 0) statistics.lengths.push_back(s);
    }
    statistics.b_standard_error = std::sqrt(variance);
    statistics.errors.moved_starts /= statistics.b;
}

ReplicateRecord ChainRun::record() const {
    ReplicateRecord record(RasterWindow(scene_.film()));
    record.b = estimate_b();
    record.mutations = mutations();
    record.blocks = blocks_.totals();
    record.states = cells<ObservableMoments>();
    for (const RunningChain& c : chains_) {
        BlockSink sink{grid_, record.blocks[c.group][c.replicate]};
        c.chain.splat_held(sink);
        record.states[c.group][c.replicate] += c.states;
    }
    for (const ChainGroup& group : groups_) record.largest.push_back(group.largest);
    record.jumps.resize((*workers_.begin())->jumps.size());
    for (const auto& worker : workers_) {
        for (std::size_t g = 0; g < groups_.size(); ++g) record.largest[g] += worker->largest[g];
        for (std::size_t s = 0; s < record.jumps.size(); ++s) record.jumps[s] += worker->jumps[s];
    }
    return record;
}

}  // namespace keyhole
