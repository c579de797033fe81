// Counter-based random streams (Philox4x32-10 of Random123 [Salmon et al. 2011]).
//
// A stream is named by (seed, stream) and its position by a counter, so a chain's generator is saved and restored by
// four numbers, and no two streams ever share a number.
#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace keyhole {

class Rng {
  public:
    struct State {
        std::uint64_t seed = 0, stream = 0, block = 0;
        std::uint32_t used = 4;  // words of the current block already handed out
        bool operator==(const State&) const = default;
    };

    explicit Rng(std::uint64_t seed = 0, std::uint64_t stream = 0) : state_{seed, stream, 0, 4} {}
    explicit Rng(const State& state) : state_(state) {
        if (state_.used < 4) fill(state_.block - 1);
    }

    const State& state() const { return state_; }

    // Uniform 32-bit word.
    std::uint32_t bits() {
        if (state_.used == 4) {
            fill(state_.block++);
            state_.used = 0;
        }
        return words_[state_.used++];
    }

    // Uniform in [0, 1), 53 bits.
    double uniform() {
        const std::uint64_t high = bits(), low = bits();
        return static_cast<double>((high << 21) ^ (low >> 11)) * 0x1p-53;
    }

    // Uniform integer in [0, n), n >= 1; the bias is below n / 2^53.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(uniform() * n); }

  private:
    void fill(std::uint64_t block) {
        const r123::Philox4x32::ctr_type counter = {
            {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32),
             static_cast<std::uint32_t>(state_.stream), static_cast<std::uint32_t>(state_.stream >> 32)}};
        const r123::Philox4x32::key_type key = {
            {static_cast<std::uint32_t>(state_.seed), static_cast<std::uint32_t>(state_.seed >> 32)}};
        const auto r = r123::Philox4x32()(counter, key);
        words_ = {r[0], r[1], r[2], r[3]};
    }

    State state_;
    std::array<std::uint32_t, 4> words_{};
};

}  // namespace keyhole
