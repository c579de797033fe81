#include "base/hash.h"

#include <fmt/format.h>

#include <cstring>

namespace keyhole {

void Hash::add(const void* bytes, std::size_t size) {
    const char* at = static_cast<const char*>(bytes);
    mix(size);
    for (; size >= 8; at += 8, size -= 8) {
        std::uint64_t word;
        std::memcpy(&word, at, 8);
        mix(word);
    }
    std::uint64_t rest = 0;
    std::memcpy(&rest, at, size);
    if (size > 0) mix(rest);
}

std::uint64_t Hash::value() const {
    std::uint64_t h = state_;  // the finaliser of MurmurHash3
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return h ^ (h >> 33);
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace keyhole
