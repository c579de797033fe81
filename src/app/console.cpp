#include "app/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/units.h"

namespace keyhole {
namespace {

bool stderr_is_terminal() {
    const char* term = std::getenv("TERM");
    return isatty(STDERR_FILENO) && term && std::strcmp(term, "dumb") != 0;
}

int terminal_width() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(double fraction, int width) {
    const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
    return "[" + std::string(static_cast<std::size_t>(full), '#') +
           std::string(static_cast<std::size_t>(width - full), '-') + "]";
}

}  // namespace

void print_error(const std::string& message) { std::fputs(("keyhole: error: " + message + "\n").c_str(), stderr); }

void print_warning(const std::string& message) { std::fputs(("keyhole: warning: " + message + "\n").c_str(), stderr); }

std::string progress_text(const Progress& progress, const std::string& unit, int width) {
    const std::string head =
        fmt::format("{:<9} {:3.0f}% ", progress.phase, 100 * std::clamp(progress.fraction, 0.0, 1.0));
    std::string tail;
    if (progress.rate > 0) tail += fmt::format(" {} {}/s", format_count(progress.rate), unit);
    if (progress.acceptance >= 0) tail += fmt::format(", {:.1f}% accepted", 100 * progress.acceptance);
    tail += fmt::format(", {} elapsed", format_duration(progress.elapsed));
    if (progress.remaining >= 0) tail += fmt::format(", {} left", format_duration(progress.remaining));
    if (tail[0] == ',') tail.erase(0, 1);
    const int room = width - static_cast<int>(head.size() + tail.size()) - 2;
    std::string text = head + (room >= 5 ? bar(progress.fraction, std::min(room, 30)) : "") + tail;
    return text.substr(0, static_cast<std::size_t>(std::max(width, 0)));
}

ProgressLine::ProgressLine(Verbosity verbosity, std::string unit)
    : verbosity_(verbosity), unit_(std::move(unit)), terminal_(stderr_is_terminal()) {}

ProgressLine::~ProgressLine() { clear(); }

// Ten times a second on a terminal. In a log: at each new phase, then every ten seconds (two with -v) or, in a long
// run, every hundredth of it.
bool ProgressLine::due(const Progress& progress) {
    const Clock::time_point now = Clock::now();
    const bool new_phase = progress.phase != phase_;
    if (!new_phase && now < next_) return false;
    phase_ = progress.phase;
    double interval = 0.1;
    if (!terminal_) {
        const double total = progress.elapsed + std::max(progress.remaining, 0.0);
        interval = std::max(verbosity_ == Verbosity::verbose ? 2.0 : 10.0, total / 100);
    }
    next_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval));
    return true;
}

void ProgressLine::erase() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

void ProgressLine::show(const Progress& progress) {
    if (verbosity_ == Verbosity::quiet) return;
    const std::lock_guard lock(mutex_);
    if (!due(progress)) return;
    erase();
    // A full last column would wrap the line.
    std::fputs(progress_text(progress, unit_, terminal_ ? terminal_width() - 1 : 120).c_str(), stderr);
    if (!terminal_) std::fputc('\n', stderr);
    drawn_ = terminal_;
    std::fflush(stderr);
}

void ProgressLine::clear() {
    const std::lock_guard lock(mutex_);
    erase();
}

void ProgressLine::warn(const std::string& message) {
    const std::lock_guard lock(mutex_);
    erase();
    print_warning(message);
}

}  // namespace keyhole
