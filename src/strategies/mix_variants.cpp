#include "strategies/mix_variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "strategies/mix_file.h"

namespace keyhole {
namespace {

constexpr double step = 3;  // by which weights and sizes are changed

// Mixes whose strategies compete. Those of one space alone are not among them: where they mix slowly it takes longer
// than a race to see it, and where they are good a mix of both is nearly as good. Where light is hard to find this is
// true of mixes without bidirectional mutations as well.
const std::vector<std::string> sets_of_easy = {"fused", "fused-portal", "fused-all"};
const std::vector<std::string> sets_of_hard = {"fused-portal", "fused-all"};

// Without strategies where the set has one that the pool leaves out.
Mix from_set(const Mix& pool, const Mix& set, const std::function<bool(const MixStrategy&)>& applies) {
    Mix mix = pool;
    mix.tuning = Mix::Tuning::off;
    mix.strategies.clear();
    for (const MixStrategy& s : set.strategies) {
        if (!(s.weight > 0)) continue;
        const auto own = std::find_if(pool.strategies.begin(), pool.strategies.end(),
                                      [&](const MixStrategy& p) { return p.info == s.info && p.weight > 0; });
        const bool left_out = own == pool.strategies.end();
        if (!applies(left_out ? s : *own)) continue;
        if (left_out) {
            mix.strategies.clear();
            return mix;
        }
        mix.strategies.push_back(*own);
        mix.strategies.back().weight *= s.weight;
    }
    if (contradiction(mix)) mix.strategies.clear();
    return mix;
}

}  // namespace

std::vector<MixVariant> sets_of(const Mix& pool, bool easy, const std::function<bool(const MixStrategy&)>& applies) {
    std::vector<MixVariant> variants;
    for (const std::string& name : easy ? sets_of_easy : sets_of_hard) {
        Mix mix = from_set(pool, builtin_mix(name), applies);
        const bool known = std::any_of(variants.begin(), variants.end(),
                                       [&](const MixVariant& v) { return v.mix.strategies == mix.strategies; });
        if (!mix.strategies.empty() && !known) variants.push_back({name, std::move(mix)});
    }
    if (variants.empty()) {  // strategies that no set has
        variants.push_back({pool.name, pool});
        variants.front().mix.tuning = Mix::Tuning::off;
    }
    return variants;
}

std::vector<MixVariant> neighbours_of(const MixVariant& best) {
    std::vector<MixVariant> variants;
    for (std::size_t i = 0; i < best.mix.strategies.size(); ++i)
        for (const double factor : {step, 1 / step}) {
            const auto name = [&](const char* what) {
                return fmt::format("{}, {} of {} {}{}", best.name, what, best.mix.strategies[i].label,
                                   factor > 1 ? "times " : "over ", step);
            };
            MixVariant weight{name("weight"), best.mix};
            weight.mix.strategies[i].weight *= factor;
            if (best.mix.strategies.size() > 1) variants.push_back(std::move(weight));
            MixVariant size{name("steps"), best.mix};
            if (scale_steps(size.mix.strategies[i], factor)) variants.push_back(std::move(size));
        }
    return variants;
}

}  // namespace keyhole
