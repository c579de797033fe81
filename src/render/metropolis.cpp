#include "render/metropolis.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <cmath>

#include "base/parallel.h"
#include "render/bootstrap.h"
#include "render/chain_worker.h"
#include "render/run_control.h"

namespace keyhole {
namespace {

void report(const Diagnostics& total, const Mixture<PssState, Rng>& mixture, RenderStatistics& statistics) {
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const StrategyCounts& counts = total.strategies[i];
        StrategyStatistics s;
        s.name = mixture.strategy(i).name();
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

}  // namespace

RenderResult render_metropolis(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const FilmSettings& film = scene.film();
    const double pixels = static_cast<double>(film.crop_width) * film.crop_height;
    const auto chain_count = static_cast<std::uint64_t>(settings.chains);
    const auto budget =
        static_cast<std::uint64_t>(std::ceil(settings.mutations_per_pixel * pixels / static_cast<double>(chain_count)));
    RunControl control(settings, callbacks, budget);
    RenderResult result;
    RenderStatistics& statistics = result.statistics;

    control.announce("bootstrap", 0);
    const CoordinateLayout layout(scene, settings.max_length);
    TechniqueDistribution techniques(settings.min_length, settings.max_length);
    Bootstrap bootstrap = run_bootstrap(
        scene, layout, techniques, static_cast<std::uint64_t>(settings.bootstrap_samples), chain_count, settings.seed);
    statistics.seconds_bootstrap = control.elapsed();
    statistics.rays = bootstrap.rays;
    statistics.non_finite = bootstrap.non_finite;
    if (bootstrap.seeds.empty()) {
        result.image = Image(film.crop_width, film.crop_height);
        statistics.warnings.push_back("no bootstrap path carries light: the image is black");
        return result;
    }

    std::vector<RunningChain> chains;
    chains.reserve(chain_count);
    for (std::uint64_t i = 0; i < chain_count; ++i)
        chains.push_back(
            {Chain<PssState>(std::move(bootstrap.seeds[i])), Rng(settings.seed, stream(StreamUse::chain, i)), {}});
    bootstrap.seeds.clear();

    tbb::enumerable_thread_specific<std::unique_ptr<ChainWorker>> workers(
        [&] { return std::make_unique<ChainWorker>(scene, layout, techniques, settings); });
    auto estimate_b = [&] {
        RunningMean b = bootstrap.b;
        for (const RunningChain& c : chains) b.merge(c.b);
        return b;
    };
    auto count = [&] {
        Diagnostics total((*workers.begin())->mixture.size());
        for (const auto& worker : workers) total += worker->diagnostics;
        return total;
    };
    auto develop = [&] {
        MetropolisFilm sum(film);
        for (const auto& worker : workers) sum.merge(worker->film);
        FilmSink sink{sum};
        for (const RunningChain& c : chains) c.chain.splat_held(sink);
        return sum.develop(estimate_b().mean() /
                           (static_cast<double>(control.done()) * static_cast<double>(chain_count)));
    };

    while (const std::uint64_t mutations = control.next_pass()) {
        parallel_for(chain_count, [&](std::uint64_t i) { workers.local()->advance(chains[i], mutations); });
        control.finished(mutations, static_cast<double>(chain_count), count().total().mean_acceptance(), develop);
    }

    result.image = develop();
    const RunningMean b = estimate_b();
    const double area = RasterWindow(film).area();
    statistics.b = b.mean() / area;
    statistics.b_standard_error = b.standard_error() / area;
    statistics.mutations = control.done() * chain_count;
    for (const auto& worker : workers) statistics.rays += worker->chart.tracer().rays();
    report(count(), (*workers.begin())->mixture, statistics);
    statistics.seconds_render = control.loop_seconds();
    statistics.interrupted = control.stopped();
    return result;
}

}  // namespace keyhole
