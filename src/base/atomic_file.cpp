#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace keyhole {
namespace {

// Names a signal handler can read without locks. A slot's text is written while `taken` and before `visible`.
struct Slot {
    std::atomic<bool> taken{false}, visible{false};
    std::array<char, 4096> name{};
};
std::array<Slot, 8> slots;

int publish(const std::string& name) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        if (name.size() >= slots[i].name.size() || slots[i].taken.exchange(true)) continue;
        std::copy_n(name.c_str(), name.size() + 1, slots[i].name.begin());
        slots[i].visible.store(true);
        return static_cast<int>(i);
    }
    return -1;  // such a file is cleaned up by its destructor only
}

void withdraw(int slot) {
    if (slot < 0) return;
    slots[static_cast<std::size_t>(slot)].visible.store(false);
    slots[static_cast<std::size_t>(slot)].taken.store(false);
}

std::string temporary_name(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter{0};
    const std::string name = "." + path.filename().string() + "." + std::to_string(getpid()) + "." +
                             std::to_string(counter.fetch_add(1)) + ".tmp";
    return (path.parent_path() / name).string();
}

[[noreturn]] void fail(const std::string& filename, const std::string& reason) {
    throw std::runtime_error("cannot write '" + filename + "': " + reason);
}

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

AtomicFile::AtomicFile(std::string filename)
    : filename_(std::move(filename)), temporary_(temporary_name(filename_)), slot_(publish(temporary_)) {}

AtomicFile::~AtomicFile() {
    if (!temporary_.empty()) unlink(temporary_.c_str());
    withdraw(slot_);
}

void AtomicFile::commit() {
    if (std::rename(temporary_.c_str(), filename_.c_str()) != 0) fail(filename_, reason(errno));
    temporary_.clear();
}

void write_file(const std::string& filename, std::string_view bytes) {
    AtomicFile file(filename);
    std::FILE* stream = std::fopen(file.path().c_str(), "wb");
    if (!stream) fail(filename, reason(errno));
    bool written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
    int error = errno;
    if (std::fclose(stream) != 0 && written) {
        written = false;
        error = errno;
    }
    if (!written) fail(filename, reason(error));
    file.commit();
}

void check_writable(const std::string& filename) {
    const std::filesystem::path path(filename);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored) || path.filename().empty()) fail(filename, "it is a folder");
    const std::string folder = path.parent_path().empty() ? "." : path.parent_path().string();
    if (!std::filesystem::exists(folder, ignored)) fail(filename, "the folder '" + folder + "' does not exist");
    const AtomicFile probe(filename);
    const int descriptor = open(probe.path().c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
    if (descriptor < 0) fail(filename, reason(errno));
    close(descriptor);
}

void remove_unfinished_files() noexcept {
    for (const Slot& slot : slots)
        if (slot.visible.load()) unlink(slot.name.data());
}

}  // namespace keyhole
