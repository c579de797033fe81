// A normal distribution whose proposals fail: what each policy for failures makes of an equal number of proposals.
//
// As published, failures are simulated: f(y) counts as zero with the probability p_f, wherever y is. That multiplies
// Z(x) by a constant, and leaving failures out does no harm. Beside it stands the same distribution with gaps where it
// is zero, so that Z depends on x: next to a gap it is small.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/vec.h"
#include "chain/metropolis.h"
#include "chain/rectification.h"
#include "compare/estimate.h"
#include "experiments/experiment.h"
#include "experiments/plot.h"

namespace keyhole {
namespace {

constexpr double mean = 3, standard_deviation = 2;  // of the target, as published
constexpr double step_standard_deviation = 2;       // of the proposals; not published
constexpr double retry_scale = 0.25;
constexpr int walk_steps = 4, bins = 48, points = 11, fewest_proposals = 100;
constexpr double first_bin = -3, bin_width = 0.25;

struct Model {
    const char* name;
    const char* title;
    double p_f;
    bool gaps;

    bool zero_at(double x) const { return gaps && ((x > 0.5 && x < 2.5) || (x > 3 && x < 5)); }
};
constexpr Model models[] = {{"p_f = 0.4", "failures at random, p_f = 0.4", 0.4, false},
                            {"p_f = 0.6", "failures at random, p_f = 0.6", 0.6, false},
                            {"gaps", "zero in two gaps: failures depend on the state", 0, true}};
constexpr std::array policies = {Rectification::off, Rectification::exclude, Rectification::walk_on,
                                 Rectification::retry};
constexpr std::array policy_names = {"off", "exclude", "walk-on", "retry"};

double cumulative(double x) { return 0.5 * std::erfc((mean - x) / (standard_deviation * std::numbers::sqrt2)); }

double draw_normal(Rng& rng) { return std::sqrt(-2 * std::log(1 - rng.uniform())) * std::cos(2 * pi * rng.uniform()); }

// The chain's one strategy. Counts the proposals that it makes.
class Step final : public Strategy<double, Rng> {
  public:
    Step(const Model& model, Rectification policy, std::uint64_t& proposals)
        : model_(model), policy_(policy), proposals_(proposals) {}
    std::string_view name() const override { return "step"; }

    Proposal propose(double& x, double& y, Rng& rng) const override {
        const Proposal first = step(x, x, y, step_standard_deviation, rng);
        if (first.failure == Failure::none) return first;
        if (policy_ == Rectification::walk_on)
            return walk_on(first, walk_steps, [&] { return step(x, y, y, step_standard_deviation, rng); });
        if (policy_ != Rectification::retry) return first;
        const double failed = y;
        const Proposal second = step(x, x, y, retry_scale * step_standard_deviation, rng);
        return retried(first.failure, second,
                       std::exp((sqr(failed - x) - sqr(failed - y)) / (2 * sqr(step_standard_deviation))));
    }

  private:
    // y becomes a step from `from`; the ratio is relative to x.
    Proposal step(double x, double from, double& y, double size, Rng& rng) const {
        ++proposals_;
        y = from + size * draw_normal(rng);
        if (model_.zero_at(y) || rng.uniform() < model_.p_f) return Proposal::failed(Failure::occluded);
        return {std::exp((sqr(x - mean) - sqr(y - mean)) / (2 * sqr(standard_deviation)))};
    }

    const Model& model_;
    Rectification policy_;
    std::uint64_t& proposals_;
};

struct Ignore {
    void splat(double, double) const {}
};

using Histogram = std::array<double, bins>;  // densities

Histogram exact(const Model& model) {
    Histogram density{};
    double total = 0;
    // Gaps begin and end at borders of bins.
    for (int i = 0; i < bins; ++i) {
        const double a = first_bin + i * bin_width;
        if (!model.zero_at(a + bin_width / 2)) density[i] = cumulative(a + bin_width) - cumulative(a);
        total += density[i];
    }
    const double outside = 1 - (cumulative(first_bin + bins * bin_width) - cumulative(first_bin));
    for (double& d : density) d /= (total + outside) * bin_width;
    return density;
}

// The densities that one chain finds, from an exact start, after each number of proposals.
std::vector<Histogram> run_chain(const Model& model, Rectification policy, int doublings, Rng rng) {
    std::uint64_t proposals = 0, limit = fewest_proposals;
    std::vector<Mixture<double, Rng>::Component> components;
    components.push_back({std::make_unique<Step>(model, policy, proposals), 1});
    const Mixture<double, Rng> mixture(std::move(components));
    double start;
    do start = mean + standard_deviation * draw_normal(rng);
    while (model.zero_at(start));
    Chain<double> chain(start);
    Diagnostics diagnostics(1);
    Ignore film;
    Histogram counts{};
    double samples = 0;
    std::vector<Histogram> result;
    while (static_cast<int>(result.size()) < doublings) {
        const StepOutcome outcome = chain.step(mixture, rng, film, diagnostics, policy == Rectification::exclude);
        if (!outcome.excluded) {
            ++samples;
            const double bin = std::floor((chain.current() - first_bin) / bin_width);
            if (bin >= 0 && bin < bins) ++counts[static_cast<std::size_t>(bin)];
        }
        if (proposals < limit) continue;
        Histogram density = counts;
        for (double& d : density) d /= samples * bin_width;
        result.push_back(density);
        limit *= 2;
    }
    return result;
}

struct Cell {
    Estimate rmse;
    double variance = 0, squared_bias = 0, squared_bias_error = 0;  // means over bins
};

// `runs`: densities of independent chains.
Cell summarise(const std::vector<Histogram>& runs, const Histogram& truth) {
    const double n = static_cast<double>(runs.size());
    std::vector<double> rmse;
    for (const Histogram& run : runs) {
        double sum = 0;
        for (int i = 0; i < bins; ++i) sum += sqr(run[i] - truth[i]) / bins;
        rmse.push_back(std::sqrt(sum));
    }
    Cell cell{estimate_mean(rmse), 0, 0, 0};
    double squares = 0;
    for (int i = 0; i < bins; ++i) {
        double m = 0, v = 0;
        for (const Histogram& run : runs) m += run[i] / n;
        for (const Histogram& run : runs) v += sqr(run[i] - m) / (n - 1);
        const double bias2 = sqr(m - truth[i]) - v / n;
        cell.variance += v / bins;
        cell.squared_bias += bias2 / bins;
        // Of a normal mean: Var((m - truth)^2) = 4 bias^2 v/n + 2 (v/n)^2.
        squares += 4 * std::max(0.0, bias2) * v / n + 2 * sqr(v / n);
    }
    cell.squared_bias_error = std::sqrt(squares) / bins;
    return cell;
}

}  // namespace

ExperimentResult run_proposal_failures_1d(const ExperimentOptions& options, const ExperimentCallbacks& callbacks) {
    const int runs = options.runs > 1 ? options.runs : 100;
    const int doublings = std::max(2, points + static_cast<int>(std::floor(std::log2(options.scale))));
    ExperimentResult result;
    result.json = {{"runs", runs},
                   {"bins", bins},
                   {"target", {{"mean", mean}, {"standard_deviation", standard_deviation}}},
                   {"step_standard_deviation", step_standard_deviation},
                   {"walk_steps", walk_steps},
                   {"retry_scale", retry_scale},
                   {"models", nlohmann::json::array()}};
    std::vector<PlotPanel> errors, biases;
    for (std::size_t m = 0; m < std::size(models); ++m) {
        const Model& model = models[m];
        const Histogram truth = exact(model);
        nlohmann::json entries = nlohmann::json::array();
        PlotPanel error{model.title, "proposals", "RMSE of the density", {}},
            bias{model.title, "proposals", "root of mean squared bias", {}};
        result.text += fmt::format("{}\n{:<10}", model.title, "proposals");
        std::vector<std::vector<Cell>> cells(policies.size());
        for (std::size_t p = 0; p < policies.size(); ++p) {
            result.text += fmt::format("{:>26}", policy_names[p]);
            std::vector<std::vector<Histogram>> found(static_cast<std::size_t>(runs));
            parallel_for(found.size(), [&](std::size_t r) {
                const std::uint64_t stream = (m * policies.size() + p) << 32 | r;
                found[r] = run_chain(model, policies[p], doublings, Rng(options.seed, stream));
            });
            PlotSeries e{policy_names[p], {}}, b{policy_names[p], {}};
            nlohmann::json list = nlohmann::json::array();
            for (int i = 0; i < doublings; ++i) {
                std::vector<Histogram> at;
                for (const auto& run : found) at.push_back(run[static_cast<std::size_t>(i)]);
                const Cell cell = summarise(at, truth);
                const double proposals = fewest_proposals * std::pow(2.0, i);
                const Interval interval = cell.rmse.interval.value_or(Interval{cell.rmse.mean, cell.rmse.mean});
                e.points.push_back({proposals, cell.rmse.mean, interval.low, interval.high});
                const double low = cell.squared_bias - 2 * cell.squared_bias_error,
                             high = cell.squared_bias + 2 * cell.squared_bias_error;
                // Only where it is told from zero.
                if (low > 0)
                    b.points.push_back({proposals, std::sqrt(cell.squared_bias), std::sqrt(low), std::sqrt(high)});
                list.push_back({{"proposals", proposals},
                                {"rmse", to_json(cell.rmse)},
                                {"variance", cell.variance},
                                {"squared_bias", cell.squared_bias},
                                {"squared_bias_standard_error", cell.squared_bias_error}});
                cells[p].push_back(cell);
            }
            error.series.push_back(e);
            bias.series.push_back(b);
            entries.push_back({{"policy", policy_names[p]}, {"points", list}});
        }
        for (int i = 0; i < doublings; ++i) {
            result.text += fmt::format("\n{:<10}", fewest_proposals << i);
            for (const std::vector<Cell>& of_policy : cells) {
                const Cell& cell = of_policy[static_cast<std::size_t>(i)];
                const double half = cell.rmse.interval ? (cell.rmse.interval->high - cell.rmse.interval->low) / 2 : 0;
                result.text += fmt::format("{:>26}", fmt::format("{:.5f} +- {:.5f}", cell.rmse.mean, half));
            }
        }
        result.text += "\nsquared bias at the end:";
        for (std::size_t p = 0; p < policies.size(); ++p) {
            const Cell& last = cells[p].back();
            result.text +=
                fmt::format("  {} {:.2g} +- {:.1g}", policy_names[p], last.squared_bias, 2 * last.squared_bias_error);
        }
        result.text += "\n\n";
        result.json["models"].push_back({{"name", model.name}, {"p_f", model.p_f}, {"entries", entries}});
        errors.push_back(error);
        if (std::any_of(bias.series.begin(), bias.series.end(), [](const PlotSeries& s) { return !s.points.empty(); }))
            biases.push_back(bias);
        if (callbacks.progress)
            callbacks.progress({"chains", static_cast<double>(m + 1) / std::size(models), 0, -1, 0, -1});
    }
    errors.insert(errors.end(), biases.begin(), biases.end());
    result.svg = svg_plot(fmt::format("Failing proposals in one dimension: means of {} runs", runs), errors);
    return result;
}

}  // namespace keyhole
