// What the command says on stderr, and how it shows progress there.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "render/render.h"

namespace keyhole {

// Never fail, even where stderr is a terminal or a pipe that has gone.
void print_error(const std::string& message);
void print_warning(const std::string& message);

enum class Verbosity { quiet, normal, verbose };

// A single line that is redrawn on a terminal; plain lines, ever rarer in long runs, elsewhere. Any thread may call it.
class ProgressLine {
  public:
    // `unit`: what Progress::rate counts, "mutations" or "samples".
    ProgressLine(Verbosity verbosity, std::string unit);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const Progress& progress);
    // Removes the line from the terminal.
    void clear();
    // Warnings appear even with --quiet, above the progress line.
    void warn(const std::string& message);

  private:
    using Clock = std::chrono::steady_clock;

    bool due(const Progress& progress);
    void erase();

    const Verbosity verbosity_;
    const std::string unit_;
    const bool terminal_;
    std::mutex mutex_;
    bool drawn_ = false;
    std::string phase_;
    Clock::time_point next_{};
};

// The text of the line, at most `width` columns: phase, bar, share done, rate, acceptance, elapsed and remaining time.
std::string progress_text(const Progress& progress, const std::string& unit, int width);

}  // namespace keyhole
