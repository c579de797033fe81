// Counter-based random streams (Philox4x32-10 of Random123 [Salmon et al. 2011]).
//
// A stream is named by (seed, stream) and its position by a counter, so a chain's generator is saved and restored by
// four numbers, and no two streams ever share a number.
#pragma once

#include <array>
#include <cstdint>

namespace keyhole {

class Rng {
  public:
    static constexpr std::uint32_t buffered = 32;  // words

    struct State {
        std::uint64_t seed = 0, stream = 0, block = 0;  // the next block of four words to be made
        std::uint32_t used = buffered;                  // words of the buffer already handed out
        bool operator==(const State&) const = default;
    };

    explicit Rng(std::uint64_t seed = 0, std::uint64_t stream = 0) : state_{seed, stream, 0, buffered} {}
    explicit Rng(const State& state) : state_(state) {
        if (state_.used == buffered) return;
        state_.block -= blocks;
        refill();
        state_.used = state.used;
    }

    const State& state() const { return state_; }

    // Uniform 32-bit word.
    std::uint32_t bits() {
        if (state_.used == buffered) [[unlikely]]
            refill();
        return words_[state_.used++];
    }

    // `n` <= buffered words at once, valid until the next call: the rest of a buffer that holds fewer is left out.
    const std::uint32_t* bits(std::uint32_t n) {
        if (state_.used + n > buffered) [[unlikely]]
            refill();
        state_.used += n;
        return &words_[state_.used - n];
    }

    // Uniform in [0, 1), 53 bits.
    double uniform() {
        const std::uint32_t* words = bits(2);
        const std::uint64_t both = std::uint64_t{words[0]} << 32 | words[1];
        return static_cast<double>(static_cast<std::int64_t>(both >> 11)) * 0x1p-53;
    }

    // Uniform integer in [0, n), n >= 1; the bias is below n / 2^53.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(uniform() * n); }

  private:
    static constexpr std::uint32_t blocks = buffered / 4;

    void refill();  // rng.cpp

    State state_;
    std::array<std::uint32_t, buffered> words_;
};

}  // namespace keyhole
