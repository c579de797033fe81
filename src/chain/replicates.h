// Errors of estimates from independent replicates: what is made several times over, independently, says by its own
// spread how far it can be trusted, whatever it is correlated with inside.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace keyhole {

// What one replicate adds to an estimate of the form (sum of the sums) / (sum of the counts).
struct ReplicatePart {
    double sum = 0, count = 0;
};

inline ReplicatePart total(std::span<const ReplicatePart> parts) {
    ReplicatePart total;
    for (const ReplicatePart& part : parts) {
        total.sum += part.sum;
        total.count += part.count;
    }
    return total;
}

// 1 / sqrt(1 - sum of h^2), h = a replicate's share of the count: makes up for the replicates' having pulled the
// estimate towards themselves. The same for all of them: one that found something heavy has many chains, and a factor
// of its own (1 / sqrt(1 - h), as in [MacKinnon and White 1985], HC2) would blame it a second time. Infinite if one
// replicate has all of the count: there is nothing to compare it with.
inline double leverage_factor(std::span<const ReplicatePart> parts) {
    const double all = total(parts).count;
    double left = 1;
    for (const ReplicatePart& part : parts) left -= part.count / all * (part.count / all);
    return left > 0 ? 1 / std::sqrt(left) : std::numeric_limits<double>::infinity();
}

// How far each replicate moves the estimate. The sum of the squares estimates the variance of the estimate: without
// bias where the variance of a replicate's sum is in proportion to its count, and with the relative error sqrt(2 / (R -
// 1)) of R replicates of equal size. All are 0 where nothing is counted, infinite where one replicate has all of it.
inline std::vector<double> deviations(std::span<const ReplicatePart> parts) {
    std::vector<double> result(parts.size(), 0.0);
    const ReplicatePart all = total(parts);
    if (!(all.count > 0)) return result;
    const double mean = all.sum / all.count, factor = leverage_factor(parts);
    for (std::size_t r = 0; r < parts.size(); ++r)
        result[r] = std::isinf(factor) ? factor : (parts[r].sum - mean * parts[r].count) / all.count * factor;
    return result;
}

inline double sum_of_squares(std::span<const double> values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return sum;
}

// For each bin j of sums[r][t][j], what replicate r collected in its time batch t (all have the same number of
// batches): how much more the replicates' shares of the bin differ than the changes of each replicate from batch to
// batch explain, as a ratio of variances. About 1 where batches are much longer than the chains' memory; large where
// replicates keep to different bins. Empty if there are less than two batches or replicates with anything in them.
inline std::vector<double> disagreement(const std::vector<std::vector<std::vector<double>>>& sums) {
    const std::size_t batches = sums.empty() ? 0 : sums[0].size();
    if (batches < 2) return {};
    const std::size_t bins = sums[0][0].size();
    // Sums of weight * share^2 of the batches, of the replicates and of all, whose differences are the variances.
    std::vector<double> all(bins, 0.0), of_batches(bins, 0.0), of_replicates(bins, 0.0);
    double all_weight = 0, replicates = 0;
    for (const auto& replicate : sums) {
        std::vector<double> own(bins, 0.0);
        double own_weight = 0;
        for (const auto& batch : replicate) {
            double weight = 0;
            for (const double v : batch) weight += v;
            if (!(weight > 0)) continue;
            own_weight += weight;
            for (std::size_t j = 0; j < bins; ++j) {
                own[j] += batch[j];
                of_batches[j] += batch[j] * batch[j] / weight;
            }
        }
        if (!(own_weight > 0)) continue;
        replicates += 1;
        all_weight += own_weight;
        for (std::size_t j = 0; j < bins; ++j) {
            all[j] += own[j];
            of_replicates[j] += own[j] * own[j] / own_weight;
        }
    }
    if (replicates < 2) return {};
    std::vector<double> ratios(bins, 0.0);
    for (std::size_t j = 0; j < bins; ++j) {
        const double between = (of_replicates[j] - all[j] * all[j] / all_weight) / (replicates - 1);
        const double within = (of_batches[j] - of_replicates[j]) / (replicates * static_cast<double>(batches - 1));
        if (between > 0) ratios[j] = within > 0 ? between / within : std::numeric_limits<double>::infinity();
    }
    return ratios;
}

// What disagreement() comes to for chains that forget exponentially, with the autocorrelation time `memory`, if each of
// the batches is `length` steps long: as long as batches are not much longer than the memory, a chain's changes from
// batch to batch show only a part of its noise.
inline double expected_disagreement(double memory, double length, double batches) {
    // The variance of a mean over n steps, of samples with variance one and correlation exp(-lag / decay).
    const double decay = memory / 2;
    const auto variance = [&](double n) { return 2 * decay / n * (1 - decay / n * -std::expm1(-n / decay)); };
    const double within = variance(length), between = variance(batches * length);
    return (batches - 1) * between / (within - between);
}

}  // namespace keyhole
