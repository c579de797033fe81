// What this process is, and what it has used so far.
#pragma once

#include <cstdint>
#include <string>

namespace keyhole {

// Processor time of all threads since the process started, in seconds.
double cpu_seconds();

// The largest amount of memory this process has held at once (resident), in bytes; 0 if the system does not say.
std::uint64_t peak_memory_bytes();

// The machine's memory in bytes; 0 if the system does not say.
std::uint64_t physical_memory_bytes();

// The machine as a person would name it: processor, number of threads, system.
std::string machine_name();

// The command line, quoted for a shell, with the program by its name alone; empty if the system does not say.
std::string command_line();

// Of the program's file; empty if the system does not say which it is.
std::string program_hash();

}  // namespace keyhole
