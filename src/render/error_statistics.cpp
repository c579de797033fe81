#include "render/error_statistics.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

// Limits beyond which a run is warned about. Renders of the project's scenes that are not hard keep a distance of a
// factor of three to the first two, and of 1.6 (short runs) to 3 to the last.
constexpr double fewest_effective_paths = 100;
constexpr double most_of_heaviest = 0.2;  // of the light, by the five largest samples
constexpr double most_disagreeing = 0.2;  // of the light
constexpr double most_moved = 0.05;       // of the light, that the chains have not had the time to forget

std::vector<float> block_means(const ReplicateRecord& record, const ReplicateErrors& errors, std::size_t g,
                               std::size_t r) {
    const BlockSums& blocks = record.blocks[g][r];
    const auto count = static_cast<double>(blocks.size());
    const double scale = errors.b(g) / errors.mutations(g) * count / record.window.area();
    std::vector<float> means(blocks.size());
    double all = 0;
    for (std::size_t j = 0; j < blocks.size(); ++j) {
        means[j] = static_cast<float>(scale * blocks[j]);
        all += means[j] / count;
    }
    means.push_back(static_cast<float>(all));  // the whole image's
    return means;
}

void report_blocks(const ReplicateRecord& record, ErrorStatistics& result) {
    const ReplicateErrors errors(record.b, record.mutations);
    const auto part = [&](std::size_t g, std::size_t r) { return block_means(record, errors, g, r); };
    const std::size_t values = record.blocks[0][0].size() + 1;
    result.block_errors = errors.standard_errors(values, part);
    result.block_means.assign(values, 0.0);
    for (std::size_t g = 0; g < record.blocks.size(); ++g)
        for (std::size_t r = 0; r < record.blocks[g].size(); ++r) {
            const std::vector<float> means = part(g, r);
            for (std::size_t j = 0; j < means.size(); ++j) result.block_means[j] += means[j];
        }
    result.image_mean = result.block_errors.back();
    const double mean = result.block_means.back();
    result.block_means.pop_back();
    result.block_errors.pop_back();
    double sum = 0;
    for (const double error : result.block_errors) sum += error / static_cast<double>(result.block_errors.size());
    if (mean > 0) result.blocks_relative = sum / mean;
}

// Of a mean over the states of all chains.
double squared_error_of_mean(const ReplicateRecord& record, std::size_t observable) {
    double all = 0;
    for (const auto& group : record.states)
        for (const ObservableMoments& m : group) all += static_cast<double>(m.count);
    std::vector<double> moved(record.states[0].size(), 0.0);
    for (const auto& group : record.states) {
        std::vector<ReplicatePart> parts;
        for (const ObservableMoments& m : group) parts.push_back({m.sums[observable], static_cast<double>(m.count)});
        const double share = total(parts).count / all;
        const std::vector<double> of_group = deviations(parts);
        for (std::size_t r = 0; r < moved.size(); ++r) moved[r] += share > 0 ? share * of_group[r] : 0;
    }
    return sum_of_squares(moved);
}

// A value for each of the observables, put together as those of the luminance and of the position (in pixels).
struct Followed {
    double luminance, position;
    Followed(const Observables& v, const RasterWindow& window)
        : luminance(v[log_luminance]),
          position(v[image_x] * window.size.x() * window.size.x() + v[image_y] * window.size.y() * window.size.y()) {}
};

Followed mean_square_jump(const ObservableJumps& jumps, const RasterWindow& window) {
    Observables squares;
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = jumps.mean_square(i, jump_units);
    return {squares, window};
}

// Returns a lower bound of the time in which the chains forget their position, from their jumps.
double report_mixing(const ReplicateRecord& record, RenderStatistics& statistics) {
    ObservableMoments all;
    for (const auto& group : record.states)
        for (const ObservableMoments& m : group) all += m;
    Observables variances, errors;
    for (std::size_t i = 0; i < variances.size(); ++i) {
        variances[i] = all.variance(i);
        errors[i] = squared_error_of_mean(record, i);
    }
    const Followed variance(variances, record.window), error(errors, record.window);
    const double steps = static_cast<double>(statistics.mutations);
    statistics.errors.luminance = mixing_from_error(variance.luminance, error.luminance, steps);
    statistics.errors.position = mixing_from_error(variance.position, error.position, steps);
    ObservableJumps jumps;
    for (std::size_t s = 0; s < record.jumps.size(); ++s) {
        jumps += record.jumps[s];
        const Followed jump = mean_square_jump(record.jumps[s], record.window);
        const double proposals = static_cast<double>(statistics.strategies[s].proposals);
        statistics.strategies[s].luminance = mixing_bound(variance.luminance, jump.luminance, proposals);
        statistics.strategies[s].position = mixing_bound(variance.position, jump.position, proposals);
    }
    return mixing_bound(variance.position, mean_square_jump(jumps, record.window).position, steps).autocorrelation_time;
}

// How much of the light the independent samples of largest weight carry, and how many of equal weight would know its
// amount as well.
void report_heavy_paths(const ReplicateRecord& record, ErrorStatistics& result) {
    double sum = 0;
    std::vector<RunningMean> weights(record.b.size());
    Largest<heaviest> largest;
    for (std::size_t g = 0; g < record.b.size(); ++g) {
        for (const Normalization& replicate : record.b[g]) weights[g].merge(replicate.weights);
        sum += weights[g].mean();
        for (const double w : record.largest[g].values()) largest.add(w / static_cast<double>(weights[g].count()));
    }
    result.effective_paths = effective_samples(weights);
    for (const double w : largest.values()) result.heaviest_share += w / sum;
}

void warn_of_heavy_paths(RenderStatistics& statistics) {
    const ErrorStatistics& e = statistics.errors;
    if (e.effective_paths >= fewest_effective_paths && e.heaviest_share <= most_of_heaviest) return;
    statistics.warnings.push_back(
        fmt::format("the light was found by few paths: of all independent samples, the {} of largest weight carry "
                    "{:.0f}% of it, and all together tell as much of it as {:.0f} paths of equal weight; light may be "
                    "missing or too bright. A longer bootstrap "
                    "(--set bootstrap.samples=...), more large steps (--set large-step.weight=...) or another mix "
                    "finds more of them",
                    heaviest, 100 * e.heaviest_share, e.effective_paths));
}

void warn_of_disagreement(RenderStatistics& statistics) {
    const ErrorStatistics& e = statistics.errors;
    if (e.disagreeing_light <= most_disagreeing) return;
    statistics.warnings.push_back(fmt::format(
        "independent parts of the run disagree more than their noise explains, where {:.0f}% of the image's light is: "
        "chains stay in parts of the image for most of the run, so it may look clean and be wrong. Render longer, with "
        "more large steps (--set large-step.weight=...), a longer bootstrap (--set bootstrap.samples=...) or another "
        "mix",
        100 * e.disagreeing_light));
}

// What the starts put in the wrong place decays, so its share in a chain's mean is about its autocorrelation time over
// its length, and the whole where that time is not known: the chains are too short, then.
void warn_of_moved_starts(RenderStatistics& statistics) {
    const ErrorStatistics& e = statistics.errors;
    const double times = static_cast<double>(statistics.rounds) / e.position.autocorrelation_time;
    if (e.moved_starts / std::max(1.0, times) <= most_moved) return;
    const std::string length = times > 0 ? fmt::format("each is about {:.2g} autocorrelation times long", times)
                                         : "they are too short to forget it";
    statistics.warnings.push_back(fmt::format(
        "biased by its starts: {:.0f}% of the chains start from other paths than the light is in "
        "(bootstrap.most-starts), and {}, so light that is hard to find may be too dark. Render longer, or without "
        "that bias, noisier (--set bootstrap.most-starts=1)",
        100 * e.moved_starts, length));
}

}  // namespace

void report_errors(const ReplicateRecord& record, const BlockRecord& over_time, RenderStatistics& statistics) {
    ErrorStatistics& errors = statistics.errors;
    errors.replicates = static_cast<int>(record.b[0].size());
    report_blocks(record, errors);
    const double memory = report_mixing(record, statistics);
    report_heavy_paths(record, errors);
    errors.disagreeing_light = over_time.disagreeing_light(memory);
    warn_of_heavy_paths(statistics);
    warn_of_disagreement(statistics);
    warn_of_moved_starts(statistics);
}

}  // namespace keyhole
