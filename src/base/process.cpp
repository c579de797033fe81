#include "base/process.h"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "base/hash.h"

namespace keyhole {

double cpu_seconds() {
    timespec t{};
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t) != 0) return 0;
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::uint64_t peak_memory_bytes() {
    // Linux carries ru_maxrss over from the program that started this one; VmHWM belongs to this program alone.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
    }
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
    return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

std::uint64_t physical_memory_bytes() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
    return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

namespace {

std::string read_all(const char* filename) {
    std::ifstream file(filename, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// "model name : AMD EPYC" gives "AMD EPYC".
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "";
}

std::string shell_word(const std::string& word) {
    const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

}  // namespace

std::string machine_name() {
    std::string name = processor_name();
    if (!name.empty()) name += ", ";
    name += std::to_string(std::thread::hardware_concurrency()) + " threads";
    utsname system{};
    if (uname(&system) == 0) name += std::string(", ") + system.sysname + " " + system.release + " " + system.machine;
    return name;
}

std::string command_line() {
    std::string text;
    std::istringstream words(read_all("/proc/self/cmdline"));
    for (std::string word; std::getline(words, word, '\0');)
        text += text.empty() ? shell_word(std::filesystem::path(word).filename().string()) : " " + shell_word(word);
    return text;
}

std::string program_hash() {
    const std::string bytes = read_all("/proc/self/exe");
    if (bytes.empty()) return "";
    Hash hash;
    hash.add(bytes);
    return hash_text(hash.value());
}

}  // namespace keyhole
