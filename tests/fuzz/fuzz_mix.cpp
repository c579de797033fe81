// Fuzz target: whatever the bytes, a mix file is read or refused with an InputError; what was read has a canonical text
// that reads back as the same mix.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "strategies/mix_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace keyhole;
    const std::string text(reinterpret_cast<const char*>(data), size);
    Mix mix;
    try {
        mix = parse_mix(text, "fuzz.toml");
    } catch (const InputError&) {
        return 0;
    }
    const std::string canonical = write_mix(mix);
    const Mix again = parse_mix(canonical, "again.toml");
    if (!(again == mix) || write_mix(again) != canonical) std::abort();
    return 0;
}
