// Several numbers at once, by the vector types that g++ and clang++ share: arithmetic is by element, comparisons give
// -1 (true) or 0 in integers of the same size, __builtin_convertvector converts. Each fills one AVX register.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace keyhole {

using UInt32x8 = std::uint32_t __attribute__((vector_size(32)));
using Int32x8 = std::int32_t __attribute__((vector_size(32)));
using Float8 = float __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));
using Int64x4 = std::int64_t __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));

inline constexpr int lanes = 8;  // of the widest

// From and to memory of any alignment.
template <class Lanes>
Lanes load_lanes(const void* from) {
    Lanes v;
    std::memcpy(&v, from, sizeof(v));
    return v;
}
template <class Lanes>
void store_lanes(const Lanes& v, void* to) {
    std::memcpy(to, &v, sizeof(v));
}

inline Double4 low_half(Float8 v) {
    return __builtin_convertvector(__builtin_shufflevector(v, v, 0, 1, 2, 3), Double4);
}
inline Double4 high_half(Float8 v) {
    return __builtin_convertvector(__builtin_shufflevector(v, v, 4, 5, 6, 7), Double4);
}

inline Float8 broadcast(float x) { return Float8{} + x; }
inline Float8 least(Float8 a, Float8 b) { return a < b ? a : b; }
inline Float8 greatest(Float8 a, Float8 b) { return a > b ? a : b; }
inline Float8 magnitude(Float8 v) { return v < 0 ? -v : v; }
inline Float8 square_root(Float8 v) {
    for (int i = 0; i < lanes; ++i) v[i] = __builtin_sqrtf(v[i]);
    return v;
}

// Bit i: what comparison i gave.
inline unsigned mask(Int32x8 comparison) {
#ifdef __AVX__
    return static_cast<unsigned>(__builtin_ia32_movmskps256(std::bit_cast<Float8>(comparison)));
#else
    unsigned bits = 0;
    for (int i = 0; i < lanes; ++i) bits |= static_cast<unsigned>(comparison[i] & 1) << i;
    return bits;
#endif
}

// The smallest multiple of `lanes` that is not below n.
constexpr int whole_lanes(int n) { return (n + lanes - 1) / lanes * lanes; }

}  // namespace keyhole
