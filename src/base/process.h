// What this process has used so far.
#pragma once

#include <cstdint>

namespace keyhole {

// Processor time of all threads since the process started, in seconds.
double cpu_seconds();

// The largest amount of memory this process has held at once (resident), in bytes; 0 if the system does not say.
std::uint64_t peak_memory_bytes();

}  // namespace keyhole
