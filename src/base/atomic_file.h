// A file that appears under its name only when it is complete.
#pragma once

#include <string>
#include <string_view>

namespace keyhole {

// Reserves a temporary name in the folder of `filename`. Write to path(), then commit() renames it, replacing an
// earlier file of that name in one step. Without commit() the temporary file is removed and the earlier one stays.
class AtomicFile {
  public:
    explicit AtomicFile(std::string filename);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return temporary_; }

    // Throws std::runtime_error with the system's reason.
    void commit();

  private:
    std::string filename_, temporary_;
    int slot_;
};

// Writes `bytes` as `filename` in one step. Throws std::runtime_error; a full disk counts as well.
void write_file(const std::string& filename, std::string_view bytes);

// Throws std::runtime_error if no file of that name could be written: its folder does not exist or refuses new files,
// or the name belongs to a folder. Leaves nothing behind.
void check_writable(const std::string& filename);

// Removes the temporary files of this process. Safe in a signal handler that is about to end the process.
void remove_unfinished_files() noexcept;

}  // namespace keyhole
