#include "render/exchanges.h"

#include <algorithm>
#include <map>

namespace keyhole {

Exchanges::Exchanges(std::uint64_t every, std::uint64_t seed, const std::vector<RunningChain>& chains)
    : every_(every), seed_(seed) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> cells;
    for (std::size_t i = 0; i < chains.size(); ++i)
        cells[{chains[i].group, chains[i].replicate}].push_back(static_cast<std::uint32_t>(i));
    for (auto& [key, cell] : cells) cells_.push_back(std::move(cell));
}

void Exchanges::pair_up(std::vector<std::uint32_t>& cell, const std::vector<RunningChain>& chains, Rng& rng) {
    // A round's pairs depend on that round alone, not on the order that the last one left.
    std::sort(cell.begin(), cell.end());
    for (std::size_t i = cell.size(); i > 1; --i)
        std::swap(cell[i - 1], cell[rng.below(static_cast<std::uint32_t>(i))]);
    std::sort(cell.begin(), cell.end(), [&](std::uint32_t a, std::uint32_t b) {
        return chains[a].chain.current().u.k < chains[b].chain.current().u.k;
    });
}

}  // namespace keyhole
