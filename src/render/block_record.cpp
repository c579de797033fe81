#include "render/block_record.h"

#include <cmath>

#include "chain/replicates.h"

namespace keyhole {
namespace {

// The ratio of variances in a block that the chains' memory does not explain any more. Of 16 replicates and 4 batches
// of independent samples, 6e-5 of the blocks exceed it by chance.
constexpr double tolerance = 6;

}  // namespace

void BlockRecord::take(std::vector<ByReplicate>& collected) {
    for (std::size_t g = 0; g < totals_.size(); ++g)
        for (std::size_t r = 0; r < current_.size(); ++r) {
            totals_[g][r] += collected[g][r];
            current_[r] += collected[g][r];
            collected[g][r].clear();
        }
}

void BlockRecord::passed(std::uint64_t mutations) {
    filled_ += mutations;
    if (filled_ < batch_length_) return;
    filled_ = 0;
    batches_.push_back(current_);
    for (BlockSums& sums : current_) sums.clear();
    if (batches_.size() < max_batches) return;
    for (std::size_t t = 0; t < max_batches / 2; ++t) {
        if (t > 0) batches_[t] = batches_[2 * t];
        for (std::size_t r = 0; r < current_.size(); ++r) batches_[t][r] += batches_[2 * t + 1][r];
    }
    batches_.resize(max_batches / 2);
    batch_length_ *= 2;
}

double BlockRecord::disagreeing_light(double memory) const {
    const std::size_t batches = batches_.size();
    if (batches < max_batches / 2 || !std::isfinite(memory)) return -1;
    std::vector<std::vector<std::vector<double>>> sums(current_.size());
    std::vector<double> light(current_[0].size(), 0.0);
    double all = 0;
    for (std::size_t r = 0; r < sums.size(); ++r)
        for (const ByReplicate& batch : batches_) {
            std::vector<double>& values = sums[r].emplace_back();
            for (std::size_t j = 0; j < light.size(); ++j) {
                values.push_back(batch[r][j]);
                light[j] += values.back();
                all += values.back();
            }
        }
    const std::vector<double> ratios = disagreement(sums);
    const double expected =
        expected_disagreement(memory, static_cast<double>(batch_length_), static_cast<double>(batches));
    double found = 0;
    for (std::size_t j = 0; j < ratios.size(); ++j)
        if (ratios[j] > tolerance * expected) found += light[j];
    return ratios.empty() ? -1 : found / all;
}

}  // namespace keyhole
