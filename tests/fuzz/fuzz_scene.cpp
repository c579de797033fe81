// Fuzz target: whatever the bytes, a scene file is read or refused with an InputError.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "scene/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // A file in memory; what it refers to is looked up beside it and is not there.
    static const int file = memfd_create("scene", 0);
    static const std::string name = "/proc/self/fd/" + std::to_string(file);
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
    try {
        keyhole::read_scene(name);
    } catch (const keyhole::InputError&) {
    }
    return 0;
}
