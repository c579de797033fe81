#include "render/metropolis.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <cmath>

#include "base/parallel.h"
#include "render/chain_worker.h"
#include "render/run_control.h"

namespace keyhole {
namespace {

void report(const Diagnostics& total, const std::vector<const MixStrategy*>& strategies, RenderStatistics& statistics) {
    for (std::size_t i = 0; i < strategies.size(); ++i) {
        const StrategyCounts& counts = total.strategies[i];
        StrategyStatistics s;
        s.name = strategies[i]->label;
        s.proposals = counts.proposals;
        s.accepted = counts.accepted;
        s.mean_acceptance = counts.mean_acceptance();
        for (std::size_t kind = 1; kind < failure_kinds; ++kind)
            if (counts.failures[kind]) s.failures[std::string(failure_names[kind])] = counts.failures[kind];
        statistics.strategies.push_back(std::move(s));
        const auto non_finite = counts.failed(Failure::non_finite);
        statistics.non_finite += non_finite;
        if (non_finite)
            statistics.warnings.push_back(fmt::format("{} proposals of '{}' were NaN or infinite and were rejected",
                                                      non_finite, statistics.strategies.back().name));
    }
}

void warn_of_hindrances(const Mix& mix, const Scene& scene, RenderStatistics& statistics) {
    for (const MixStrategy& s : mix.strategies)
        if (const std::string why = s.info->hindrance(scene, mix.lengths); s.weight > 0 && !why.empty())
            statistics.warnings.push_back(fmt::format("strategy '{}' never applies here: {}", s.label, why));
}

// What is known of b by group: the bootstrap's samples, and the independent proposals of the chains.
std::vector<RunningMean> estimate_b(const std::vector<ChainGroup>& groups, const std::vector<RunningChain>& chains) {
    std::vector<RunningMean> b;
    for (const ChainGroup& group : groups) b.push_back(group.b);
    for (const RunningChain& c : chains) b[c.group].merge(c.b);
    return b;
}

std::vector<std::uint64_t> count_chains(const std::vector<RunningChain>& chains, std::size_t groups) {
    std::vector<std::uint64_t> counts(groups, 0);
    for (const RunningChain& c : chains) ++counts[c.group];
    return counts;
}

void report_b(const std::vector<ChainGroup>& groups, const std::vector<RunningChain>& chains, double area,
              RenderStatistics& statistics) {
    const std::vector<RunningMean> b = estimate_b(groups, chains);
    const std::vector<std::uint64_t> counts = count_chains(chains, groups.size());
    double variance = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const LengthStatistics s{groups[g].length, counts[g], b[g].mean() / area, b[g].standard_error() / area};
        statistics.b += s.b;
        variance += s.b_standard_error * s.b_standard_error;
        if (s.length > 0) statistics.lengths.push_back(s);
    }
    statistics.b_standard_error = std::sqrt(variance);
}

}  // namespace

RenderResult render_metropolis(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const FilmSettings& film = scene.film();
    const Mix& mix = settings.mix;
    RunControl control(settings, callbacks, static_cast<std::uint64_t>(mix.chain_length),
                       static_cast<std::uint64_t>(mix.chain_count));
    RenderResult result;
    RenderStatistics& statistics = result.statistics;
    warn_of_hindrances(mix, scene, statistics);

    control.announce("bootstrap", 0);
    const CoordinateLayout layout(scene, mix.lengths.max);
    TechniqueDistribution techniques(mix.lengths.min, mix.lengths.max);
    Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, mix);
    std::vector<ChainGroup>& groups = bootstrap.groups;
    statistics.seconds_bootstrap = control.elapsed();
    statistics.rays = bootstrap.rays;
    statistics.non_finite = bootstrap.non_finite;
    if (groups.empty()) {
        result.image = Image(film.crop_width, film.crop_height);
        statistics.cpu_seconds = control.elapsed_cpu();
        statistics.warnings.push_back("no bootstrap path carries light: the image is black");
        return result;
    }

    std::vector<RunningChain> chains = start_chains(groups, mix.seed);
    const std::vector<std::uint64_t> chain_counts = count_chains(chains, groups.size());
    tbb::enumerable_thread_specific<std::unique_ptr<ChainWorker>> workers(
        [&] { return std::make_unique<ChainWorker>(scene, layout, techniques, mix, groups.size()); });
    auto count = [&] {
        Diagnostics total((*workers.begin())->mixture.size());
        for (const auto& worker : workers) total += worker->diagnostics;
        return total;
    };
    auto develop = [&] {
        const std::vector<RunningMean> b = estimate_b(groups, chains);
        Image image(film.crop_width, film.crop_height);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            MetropolisFilm sum(film);
            for (const auto& worker : workers) sum.merge(worker->films[g]);
            FilmSink sink{sum};
            for (const RunningChain& c : chains)
                if (c.group == g) c.chain.splat_held(sink);
            const double mutations = static_cast<double>(control.done()) * static_cast<double>(chain_counts[g]);
            const Image part = sum.develop(b[g].mean() / mutations);
            for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] += part.rgb[i];
        }
        return image;
    };

    while (const std::uint64_t mutations = control.next_pass()) {
        parallel_for(chains.size(), [&](std::uint64_t i) { workers.local()->advance(chains[i], mutations); });
        control.finished(mutations, count().total().mean_acceptance(), develop);
    }

    result.image = develop();
    report_b(groups, chains, RasterWindow(film).area(), statistics);
    control.report(statistics);
    for (const auto& worker : workers) statistics.rays += worker->chart.tracer().rays();
    report(count(), applicable_strategies(mix, scene), statistics);
    return result;
}

}  // namespace keyhole
