#include "render/race.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/process.h"
#include "render/cell_errors.h"
#include "render/chain_run.h"
#include "strategies/cones_bind.h"
#include "strategies/mix_variants.h"

namespace keyhole {
namespace {

// Of the render; of long ones less.
constexpr double share_of_short = 0.05, share_of_long = 0.01;
constexpr double share_of_sets = 0.6;        // of the race; the rest is for the winner's weights and sizes
constexpr int chains_of_contender = 64;      // few, so that each is long enough to show how it mixes
constexpr double fewest_mutations = 8192;    // of a contender in its first round, for a comparison to mean something
constexpr double sure = 2;                   // standard errors that one must be more efficient by than another
constexpr double worth_a_set = 1.1;          // times as efficient as the fallback, and that surely
constexpr double worth_a_change = 1.3;       // the same of a change of the winner: there are many to choose from
constexpr double largest_known_error = 0.5;  // of blocks, relative; what is seen with a larger one is mostly chance
constexpr std::uint64_t mutations_of_pass = 64;  // of each chain
constexpr int most_fine = 4;                     // cells of a block, a side

// Whether independent samples find the light: that many of them are worth one of equal weight.
constexpr double most_of_easy = 128;

bool light_is_easy_to_find(const Bootstrap& bootstrap) {
    std::vector<RunningMean> weights;
    double samples = 0;
    for (const ChainGroup& g : bootstrap.groups) {
        weights.push_back(g.all().weights);
        samples += static_cast<double>(weights.back().count());
    }
    return effective_samples(weights) * most_of_easy > samples;
}

// The chains of a part of the seeds, in order: they are in proportion to the target as all are.
Bootstrap part_of(const Bootstrap& bootstrap, int chains) {
    Bootstrap part = bootstrap;
    std::size_t all = 0;
    for (const ChainGroup& g : part.groups) all += g.seeds.size();
    const std::size_t every = std::max<std::size_t>(1, all / static_cast<std::size_t>(chains));
    for (ChainGroup& g : part.groups) {
        std::vector<ChainSeed> kept;
        for (std::size_t i = every / 2; i < g.seeds.size(); i += every) kept.push_back(g.seeds[i]);
        if (kept.empty()) kept.push_back(g.seeds[0]);
        g.seeds = std::move(kept);
    }
    return part;
}

// Cells in which errors are compared, by block and side: as many as there are pixels, but few enough to keep them of
// every replicate of every contender.
int fine_cells(const Scene& scene) {
    const int pixels = std::min(scene.film().crop_width, scene.film().crop_height) / BlockGrid::usual_side;
    return std::clamp(pixels, 1, most_fine);
}

bool applies(const MixStrategy& s, const Scene& scene, const Mix& pool, const Bootstrap& seeds) {
    if (!s.info->hindrance(scene, pool.lengths).empty()) return false;
    if (!s.info->cones) return true;
    std::vector<const PssState*> paths;
    for (const ChainGroup& g : seeds.groups)
        for (const ChainSeed& seed : g.seeds) paths.push_back(&seed.state);
    return cones_bind(s, scene, paths);
}

class Contender {
  public:
    Contender(MixVariant variant, const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
              const TechniqueDistribution& techniques, const Bootstrap& seeds)
        : name_(std::move(variant.name)), settings_(settings) {
        settings_.mix = std::move(variant.mix);
        settings_.error_image = false;
        Bootstrap own = seeds;
        for (ChainGroup& g : own.groups)
            for (ChainSeed& seed : g.seeds) fit_state(seed.state, settings_.mix);
        for (const ChainGroup& g : own.groups) chains_ += static_cast<double>(g.seeds.size());
        run_ = std::make_unique<ChainRun>(scene, settings_, layout, techniques, std::move(own),
                                          Recording{false, fine_cells(scene) * BlockGrid::usual_side});
    }

    void advance() {
        const double before = cpu_seconds();
        mutations_ += chains_ * static_cast<double>(run_->advance(mutations_of_pass));
        seconds_ += cpu_seconds() - before;
    }
    double used(const RaceLength& length) const { return length.mutations ? mutations_ : seconds_; }
    // What the error has cost. A race by numbers of mutations must end in the same way each time, so rays stand for
    // time there, and each mutation counts as one more.
    double cost(const RaceLength& length) const {
        return error * (length.mutations ? static_cast<double>(run_->rays()) + mutations_ : seconds_);
    }
    const std::string& name() const { return name_; }
    MixVariant variant() const { return {name_, settings_.mix}; }
    ReplicateRecord record() const { return run_->record(); }
    double mutations() const { return mutations_; }
    double seconds() const { return seconds_; }
    double error = 0;          // mean squared relative error of the cells
    double block_error = 0;    // of the blocks
    std::vector<Cells> cells;  // by replicate
    bool known() const { return block_error < largest_known_error * largest_known_error; }

  private:
    std::string name_;
    RenderSettings settings_;
    double chains_ = 0, mutations_ = 0, seconds_ = 0;
    std::unique_ptr<ChainRun> run_;
};

class Race {
  public:
    Race(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
         const TechniqueDistribution& techniques, const Bootstrap& seeds, const RaceLength& length,
         const std::function<bool(double)>& stop)
        : scene_(scene),
          settings_(settings),
          layout_(layout),
          techniques_(techniques),
          seeds_(seeds),
          length_(length),
          stop_(stop) {}

    // The variants race, with a share of the length; the best is first, the others follow as they dropped out. The one
    // called `stays` is there until the end.
    std::vector<std::unique_ptr<Contender>> run(std::vector<MixVariant> variants, double share,
                                                const std::string& stays) {
        std::vector<std::unique_ptr<Contender>> field, out;
        for (MixVariant& v : variants)
            field.push_back(std::make_unique<Contender>(std::move(v), scene_, settings_, layout_, techniques_, seeds_));
        const double rounds = std::max(1.0, std::ceil(std::log2(static_cast<double>(field.size()))));
        const double of_round = share * length_.amount / rounds;
        while (field.size() > 1 && !stopped_) {
            for (const auto& contender : field) advance(*contender, of_round / static_cast<double>(field.size()));
            rank(field);
            if (field.size() <= 2) break;
            const std::size_t kept = (field.size() + 1) / 2;
            for (std::size_t i = field.size(); i-- > 0 && field.size() > kept;)
                if (field[i]->name() != stays) {
                    out.insert(out.begin(), std::move(field[i]));
                    field.erase(field.begin() + static_cast<std::ptrdiff_t>(i));
                }
        }
        for (std::size_t i = field.size(); i-- > 0;) out.insert(out.begin(), std::move(field[i]));
        return out;
    }
    bool stopped() const { return stopped_; }

  private:
    void advance(Contender& contender, double amount) {
        const double begin = contender.used(length_), used_before = used_;
        do {
            contender.advance();
            used_ = used_before + contender.used(length_) - begin;
            stopped_ = stopped_ || stop_(used_ / length_.amount);
        } while (used_ - used_before < amount && !stopped_);
    }

    // By their errors times their time. All see the same image, so its means are those of all together.
    void rank(std::vector<std::unique_ptr<Contender>>& field) const {
        const auto fine = static_cast<std::size_t>(fine_cells(scene_));
        std::vector<std::vector<Cells>> cells, blocks;
        for (const auto& contender : field) {
            cells.push_back(cell_means(contender->record()));
            blocks.emplace_back();
            for (const Cells& replicate : cells.back()) blocks.back().push_back(coarser(replicate, fine));
        }
        const Cells all_cells = mean_of(cells), all_blocks = mean_of(blocks);
        for (std::size_t c = 0; c < field.size(); ++c) {
            field[c]->error = squared_error(cells[c], all_cells);
            field[c]->block_error = squared_error(blocks[c], all_blocks);
            field[c]->cells = std::move(cells[c]);
        }
        std::stable_sort(field.begin(), field.end(),
                         [&](const auto& a, const auto& b) { return a->cost(length_) < b->cost(length_); });
    }

    const Scene& scene_;
    const RenderSettings& settings_;
    const CoordinateLayout& layout_;
    const TechniqueDistribution& techniques_;
    const Bootstrap& seeds_;
    const RaceLength& length_;
    const std::function<bool(double)>& stop_;
    double used_ = 0;
    bool stopped_ = false;
};

void report(const std::vector<std::unique_ptr<Contender>>& field, TuningStatistics& statistics) {
    for (const auto& c : field) {
        statistics.contenders.push_back({c->name(), c->mutations(), c->seconds(), std::sqrt(c->error)});
        statistics.cpu_seconds += c->seconds();
        statistics.mutations += c->mutations();
    }
}

// The first of the field, if it is known to be better by the factor than the one of that name, where that is there.
// The two have raced to the end.
const Contender& better(const std::vector<std::unique_ptr<Contender>>& field, const std::string& than, double factor,
                        const RaceLength& length) {
    const Contender& first = *field.front();
    const auto found = std::find_if(field.begin(), field.end(), [&](const auto& c) { return c->name() == than; });
    if (found == field.end()) return first;
    const Contender& other = **found;
    if (&other == &first || !first.known()) return other;
    const double gain = std::log(other.cost(length) / first.cost(length));
    const double error = error_of_log_ratio(first.cells, other.cells, mean_of({first.cells, other.cells}));
    return gain > std::log(factor) && gain > sure * error ? first : other;
}

}  // namespace

RaceLength RaceLength::of(const RenderSettings& s, int threads) {
    const auto share = [](double whole, double short_one) {
        return std::min(share_of_short * whole, short_one + share_of_long * whole);
    };
    if (s.cpu_seconds > 0) return {share(s.cpu_seconds, 5), false};
    if (s.seconds > 0) return {share(s.seconds * threads, 5.0 * threads), false};
    return {share(static_cast<double>(s.mix.chain_length) * s.mix.chain_count, 5e6), true};
}

RaceResult race(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
                const TechniqueDistribution& techniques, const Bootstrap& bootstrap, const RaceLength& length,
                const std::function<bool(double share)>& stop) {
    const Bootstrap seeds = part_of(bootstrap, chains_of_contender);
    Race race(scene, settings, layout, techniques, seeds, length, stop);
    RaceResult result;
    std::vector<MixVariant> all = sets_of(settings.mix, light_is_easy_to_find(bootstrap),
                                          [&](const MixStrategy& s) { return applies(s, scene, settings.mix, seeds); });
    const std::string fallback = all.front().name;  // of a race without a clear result
    if (all.size() == 1) {
        result.statistics.winner = all.front().name;
        result.mix = std::move(all.front().mix);
        return result;
    }
    const auto field = race.run(std::move(all), share_of_sets, fallback);
    report(field, result.statistics);
    const Contender& winner = better(field, fallback, worth_a_set, length);
    MixVariant best = winner.variant();

    std::vector<MixVariant> variants = neighbours_of(best);
    const double each =
        (1 - share_of_sets) * length.amount /
        (std::ceil(std::log2(static_cast<double>(variants.size() + 1))) * static_cast<double>(variants.size() + 1));
    const double mutations = length.mutations ? each : each * winner.mutations() / winner.seconds();
    if (!race.stopped() && !variants.empty() && mutations >= fewest_mutations && winner.known()) {
        variants.insert(variants.begin(), best);
        const auto tuned = race.run(std::move(variants), 1 - share_of_sets, best.name);
        report(tuned, result.statistics);
        best = better(tuned, best.name, worth_a_change, length).variant();
    }
    result.statistics.winner = best.name;
    result.statistics.clear = winner.known();
    result.mix = std::move(best.mix);
    return result;
}

}  // namespace keyhole
