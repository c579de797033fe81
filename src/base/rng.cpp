#include "base/rng.h"

#include <Random123/philox.h>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace keyhole {
namespace {

constexpr std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
constexpr std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }

#ifdef __AVX2__
// Four blocks at once, each word in the low half of its 64 bits (what the high halves hold does not matter): the rounds
// of r123::Philox4x32, which takes three times as long.
void philox(std::uint64_t block, std::uint64_t stream, std::uint64_t seed, std::uint32_t* words) {
    __m256i c0 = _mm256_add_epi64(_mm256_set1_epi64x(static_cast<long long>(block)), _mm256_set_epi64x(3, 2, 1, 0));
    __m256i c1 = _mm256_srli_epi64(c0, 32);
    __m256i c2 = _mm256_set1_epi64x(low(stream)), c3 = _mm256_set1_epi64x(high(stream));
    __m256i k0 = _mm256_set1_epi64x(low(seed)), k1 = _mm256_set1_epi64x(high(seed));
    for (int round = 0; round < 10; ++round) {
        const __m256i a = _mm256_mul_epu32(c0, _mm256_set1_epi64x(PHILOX_M4x32_0));
        const __m256i b = _mm256_mul_epu32(c2, _mm256_set1_epi64x(PHILOX_M4x32_1));
        c0 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(b, 32), c1), k0);
        c1 = b;
        c2 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(a, 32), c3), k1);
        c3 = a;
        k0 = _mm256_add_epi32(k0, _mm256_set1_epi64x(PHILOX_W32_0));
        k1 = _mm256_add_epi32(k1, _mm256_set1_epi64x(PHILOX_W32_1));
    }
    // Pairs of words, then blocks 0 and 2, 1 and 3 of four words.
    const __m256i first = _mm256_blend_epi32(c0, _mm256_slli_epi64(c1, 32), 0b10101010);
    const __m256i second = _mm256_blend_epi32(c2, _mm256_slli_epi64(c3, 32), 0b10101010);
    const __m256i even = _mm256_unpacklo_epi64(first, second), odd = _mm256_unpackhi_epi64(first, second);
    auto* out = reinterpret_cast<__m256i*>(words);
    _mm256_storeu_si256(out, _mm256_permute2x128_si256(even, odd, 0x20));
    _mm256_storeu_si256(out + 1, _mm256_permute2x128_si256(even, odd, 0x31));
}
#else
void philox(std::uint64_t block, std::uint64_t stream, std::uint64_t seed, std::uint32_t* words) {
    for (std::uint64_t b = block; b < block + 4; ++b) {
        for (const std::uint32_t word :
             r123::Philox4x32()({{low(b), high(b), low(stream), high(stream)}}, {{low(seed), high(seed)}}))
            *words++ = word;
    }
}
#endif

}  // namespace

void Rng::refill() {
    for (std::uint32_t i = 0; i < buffered; i += 16, state_.block += 4)
        philox(state_.block, state_.stream, state_.seed, &words_[i]);
    state_.used = 0;
}

}  // namespace keyhole
