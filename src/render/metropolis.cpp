#include "render/metropolis.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "base/parallel.h"
#include "render/error_statistics.h"
#include "render/exchanges.h"
#include "render/run_control.h"

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

// What the mix cannot do in the scene, or does wrong by intention.
void warn_of_mix(const Mix& mix, const Scene& scene, RenderStatistics& statistics) {
    for (const MixStrategy& s : mix.strategies)
        if (const std::string why = s.info->hindrance(scene, mix.lengths); s.weight > 0 && !why.empty())
            statistics.warnings.push_back(fmt::format("strategy '{}' never applies here: {}", s.label, why));
    if (mix.rectification.policy == Rectification::exclude)
        statistics.warnings.push_back(
            "biased: proposals without contribution are left out (rectification = \"exclude\"), which darkens what "
            "often fails, such as the surroundings of occluders, and brightens the rest; \"walk-on\" and \"retry\" are "
            "exact");
    if (mix.techniques.light_vertices != LightVertices::any)
        statistics.warnings.push_back(
            "only some techniques are in use (techniques.light-vertices): light that no other finds is missing");
}

// By group and replicate.
template <class T>
using Cells = std::vector<std::vector<T>>;

RunningMean merged(const std::vector<RunningMean>& replicates) {
    RunningMean all;
    for (const RunningMean& mean : replicates) all.merge(mean);
    return all;
}

// The chains of a run and all that they leave behind.
class ChainRun {
  public:
    ChainRun(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
             const TechniqueDistribution& techniques, Bootstrap bootstrap)
        : scene_(scene),
          groups_(std::move(bootstrap.groups)),
          chains_(start_chains(groups_, settings.mix.seed)),
          chain_counts_(cells<double>()),
          blocks_(groups_.size(), replicates()),
          workers_([&, this] {
              return std::make_unique<ChainWorker>(scene, layout, techniques, settings.mix, groups_.size(),
                                                   settings.error_image ? &replicate_films_ : nullptr);
          }) {
        for (const RunningChain& c : chains_) ++chain_counts_[c.group][c.replicate];
        if (settings.mix.exchange_every > 0)
            exchanges_.emplace(static_cast<std::uint64_t>(settings.mix.exchange_every), settings.mix.seed, chains_);
        if (settings.error_image) replicate_films_ = cells(SharedMetropolisFilm(scene.film()));
    }

    // Makes at most that many mutations of each chain, and returns how many.
    std::uint64_t advance(std::uint64_t most) {
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

    Diagnostics diagnostics() const {
        Diagnostics total((*workers_.begin())->mixture.size());
        for (const auto& worker : workers_) total += worker->diagnostics;
        return total;
    }

    Image develop() const {
        const Cells<RunningMean> b = estimate_b();
        Image image(scene_.film().crop_width, scene_.film().crop_height);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            MetropolisFilm sum(scene_.film());
            for (const auto& worker : workers_)
                if (!worker->films.empty()) sum.merge(worker->films[g]);
            if (!replicate_films_.empty())
                for (const SharedMetropolisFilm& film : replicate_films_[g]) sum.merge(film);
            FilmSink sink{sum};
            splat_held(sink, g);
            const Image part = sum.develop(merged(b[g]).mean() / mutations(g));
            for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] += part.rgb[i];
        }
        return image;
    }

    // Standard errors of the values of develop(). Only where there are films of replicates.
    Image develop_errors() const {
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

    void report(const std::vector<const MixStrategy*>& strategies, RenderStatistics& statistics) const {
        for (const auto& worker : workers_) statistics.rays += worker->evaluator->tracer().rays();
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

  private:
    std::size_t replicates() const { return groups_[0].b.size(); }
    template <class T>
    Cells<T> cells(const T& value = T()) const {
        return Cells<T>(groups_.size(), std::vector<T>(replicates(), value));
    }
    static constexpr std::size_t every = ~std::size_t{0};

    template <class Sink>
    void splat_held(Sink& sink, std::size_t group, std::size_t replicate = every) const {
        for (const RunningChain& c : chains_)
            if (c.group == group && (replicate == every || c.replicate == replicate)) c.chain.splat_held(sink);
    }

    // From the bootstrap's samples and the independent proposals of the chains.
    Cells<RunningMean> estimate_b() const {
        Cells<RunningMean> b;
        for (const ChainGroup& group : groups_) b.push_back(group.b);
        for (const RunningChain& c : chains_) b[c.group][c.replicate].merge(c.b);
        return b;
    }

    Cells<double> mutations() const {
        Cells<double> result = chain_counts_;
        for (std::vector<double>& group : result)
            for (double& count : group) count *= static_cast<double>(done_);
        return result;
    }
    double chains_of(std::size_t group) const {
        return std::accumulate(chain_counts_[group].begin(), chain_counts_[group].end(), 0.0);
    }
    double mutations(std::size_t group) const { return chains_of(group) * static_cast<double>(done_); }

    void report_b(RenderStatistics& statistics) const {
        const double area = RasterWindow(scene_.film()).area();
        const Cells<RunningMean> b = estimate_b();
        double variance = 0;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const RunningMean all = merged(b[g]);
            const auto chains = static_cast<std::uint64_t>(chains_of(g));
            const LengthStatistics s{groups_[g].length, chains, all.mean() / area, all.standard_error() / area};
            statistics.b += s.b;
            variance += s.b_standard_error * s.b_standard_error;
            if (s.length > 0) statistics.lengths.push_back(s);
        }
        statistics.b_standard_error = std::sqrt(variance);
    }

    RunRecord record() const {
        RunRecord record(RasterWindow(scene_.film()));
        record.b = estimate_b();
        record.mutations = mutations();
        record.blocks = blocks_.totals();
        record.states = cells<ObservableMoments>();
        const BlockGrid grid(record.window);
        for (const RunningChain& c : chains_) {
            BlockSink sink{grid, record.blocks[c.group][c.replicate]};
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

    const Scene& scene_;
    std::vector<ChainGroup> groups_;
    std::vector<RunningChain> chains_;
    Cells<double> chain_counts_;
    BlockRecord blocks_;
    ReplicateFilms replicate_films_;
    tbb::enumerable_thread_specific<std::unique_ptr<ChainWorker>> workers_;
    std::optional<Exchanges> exchanges_;
    std::uint64_t done_ = 0;  // mutations of each chain
};

}  // namespace

RenderResult render_metropolis(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const FilmSettings& film = scene.film();
    const Mix& mix = settings.mix;
    RunControl control(settings, callbacks, static_cast<std::uint64_t>(mix.chain_length),
                       static_cast<std::uint64_t>(mix.chain_count));
    RenderResult result;
    RenderStatistics& statistics = result.statistics;
    warn_of_mix(mix, scene, statistics);

    control.announce("bootstrap", 0);
    const CoordinateLayout layout(scene, mix.lengths.max);
    TechniqueDistribution techniques = make_techniques(mix);
    Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, mix);
    statistics.seconds_bootstrap = control.elapsed();
    statistics.rays = bootstrap.rays;
    statistics.non_finite = bootstrap.non_finite;
    if (bootstrap.groups.empty()) {
        result.image = result.error = Image(film.crop_width, film.crop_height);
        statistics.cpu_seconds = control.elapsed_cpu();
        statistics.warnings.push_back("no bootstrap path carries light: the image is black");
        return result;
    }

    ChainRun run(scene, settings, layout, techniques, std::move(bootstrap));
    while (const std::uint64_t pass = control.next_pass()) {
        const std::uint64_t mutations = run.advance(pass);
        control.finished(mutations, run.diagnostics().total().mean_acceptance(), [&] { return run.develop(); });
    }

    result.image = run.develop();
    if (settings.error_image) result.error = run.develop_errors();
    control.report(statistics);
    run.report(applicable_strategies(mix, scene), statistics);
    return result;
}

}  // namespace keyhole
