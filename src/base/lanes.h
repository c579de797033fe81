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

// The smallest multiple of `lanes` that is not below n.
constexpr int whole_lanes(int n) { return (n + lanes - 1) / lanes * lanes; }

}  // namespace keyhole
