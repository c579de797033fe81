// A hash of what bytes say, to notice changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace keyhole {

// A 64-bit hash that is fed bytes: FNV-1a over words of eight bytes with a final avalanche. Not cryptographic.
class Hash {
  public:
    // The length is part of the hash, so ("ab", "c") differs from ("a", "bc").
    void add(const void* bytes, std::size_t size);
    void add(const std::string& text) { add(text.data(), text.size()); }
    void add(std::uint64_t word) { mix(word); }
    std::uint64_t value() const;

  private:
    void mix(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3ull;
        state_ ^= state_ >> 29;  // FNV alone never carries high bits down
    }
    std::uint64_t state_ = 0xcbf29ce484222325ull;
};

// As 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace keyhole
