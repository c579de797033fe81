#include "render/cell_errors.h"

#include <cmath>
#include <limits>

#include "chain/running_mean.h"

namespace keyhole {
namespace {

std::size_t side_of(const Cells& cells) {
    return static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(cells.size()))));
}

// Where cell j of a grid lies in the grid of `by` x `by` cells each.
std::size_t coarser_index(std::size_t j, std::size_t side, std::size_t by) {
    return j / side / by * (side / by) + j % side / by;
}

}  // namespace

std::vector<Cells> cell_means(const ReplicateRecord& record) {
    std::vector<Cells> means;
    for (std::size_t r = 0; r < record.blocks[0].size(); ++r) {
        Cells sum(record.blocks[0][r].size());
        bool has_chains = false;
        for (std::size_t g = 0; g < record.blocks.size(); ++g) {
            const double mutations = record.mutations[g][r];
            if (!(mutations > 0)) continue;
            has_chains = true;
            Normalization b;
            for (const Normalization& replicate : record.b[g]) b.merge(replicate);
            for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += b.b() * record.blocks[g][r][j] / mutations;
        }
        if (has_chains) means.push_back(std::move(sum));
    }
    return means;
}

Cells coarser(const Cells& cells, std::size_t by) {
    const std::size_t side = side_of(cells);
    Cells sums(cells.size() / (by * by));
    for (std::size_t j = 0; j < cells.size(); ++j) sums[coarser_index(j, side, by)] += cells[j];
    return sums;
}

Cells mean_of(const std::vector<std::vector<Cells>>& runs) {
    Cells mean(runs[0][0].size());
    for (const std::vector<Cells>& replicates : runs)
        for (const Cells& r : replicates)
            for (std::size_t j = 0; j < mean.size(); ++j)
                mean[j] += r[j] / static_cast<double>(replicates.size() * runs.size());
    return mean;
}

double squared_error(const std::vector<Cells>& replicates, const Cells& all) {
    constexpr std::size_t parts = 4;
    const auto n = static_cast<double>(replicates.size()), count = static_cast<double>(all.size());
    double mean = 0;
    for (const double v : all) mean += v / count;
    if (n < 2 || !(mean > 0)) return std::numeric_limits<double>::infinity();
    const std::size_t side = side_of(all), by = side / parts;
    const Cells light = coarser(all, by);
    double error = 0;
    for (std::size_t j = 0; j < all.size(); ++j) {
        double own = 0, square = 0;
        for (const Cells& r : replicates) own += r[j] / n;
        for (const Cells& r : replicates) square += (r[j] - own) * (r[j] - own);
        const double expected = light[coarser_index(j, side, by)] / static_cast<double>(by * by);
        error += square / (n * (n - 1)) / (expected * expected + mean * mean);
    }
    return error / count;
}

double error_of_log_ratio(const std::vector<Cells>& a, const std::vector<Cells>& b, const Cells& all) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    if (a.size() != b.size() || a.size() < 3) return unknown;
    const auto without = [](std::vector<Cells> replicates, std::size_t r) {
        replicates.erase(replicates.begin() + static_cast<std::ptrdiff_t>(r));
        return replicates;
    };
    RunningMean ratios;
    for (std::size_t r = 0; r < a.size(); ++r) {
        const double ratio = std::log(squared_error(without(a, r), all) / squared_error(without(b, r), all));
        if (!std::isfinite(ratio)) return unknown;
        ratios.add(ratio);
    }
    const auto n = static_cast<double>(a.size());
    return std::sqrt(ratios.variance() / n) * (n - 1);
}

}  // namespace keyhole
