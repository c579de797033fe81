// Files that a scene refers to.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace keyhole {

// The whole file. Throws InputError at `from`, the place that names the file.
std::string read_file(const std::string& filename, const SourceLocation& from);

// Where the file `name`, written in the file `from.file` of the scene `scene_file`, lies: beside the file that names
// it, else beside the scene. Absolute paths are kept. Throws InputError at `from` if it is not there.
std::string find_file(const std::string& name, const SourceLocation& from, const std::string& scene_file);

// One name per file, whatever way it was reached.
std::string canonical_path(const std::string& filename);

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

}  // namespace keyhole
