// Runs the command as a user does: as a process of its own, in a temporary folder.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace keyhole {

struct Finished {
    int exit_code = -1;  // 128 + number if a signal killed it
    std::string out, err;
};

// A running `keyhole`. Its stdout and stderr go to files beside the working folder.
class Process {
  public:
    // `prepare` runs in the child just before the command starts.
    Process(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
            const std::function<void()>& prepare = {});
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    // Waits up to a minute for the condition; false if the process ended or the time was up before.
    bool wait_until(const std::function<bool()>& condition);
    void signal(int number) const;
    std::string err() const;
    Finished wait();

  private:
    bool running();

    std::filesystem::path logs_;
    pid_t pid_;
    int status_ = 0;
    bool finished_ = false;
};

class CommandTest : public testing::Test {
  protected:
    CommandTest();
    ~CommandTest() override;

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    std::string write(const std::string& name, const std::string& text) const;  // returns the name
    nlohmann::json json(const std::string& name) const;

    Finished run(const std::vector<std::string>& arguments) const;
    // The names of all files in the folder, hidden ones too.
    std::vector<std::string> files() const;

    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path root_, folder_;
};

// A closed room with a light, glass and a mirror, 16x16 pixels, in the 3.x dialect.
extern const char* const room_scene;

// Arguments that render `scene` in a moment.
std::vector<std::string> quick_render(const std::string& scene, std::vector<std::string> more = {});

}  // namespace keyhole
