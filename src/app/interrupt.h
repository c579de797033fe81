// Ctrl-C and its like while an image is being made: the first asks for an end, the second ends at once.
#pragma once

#include <signal.h>

#include <array>

namespace keyhole {

// While one exists, the first SIGINT, SIGTERM or SIGHUP is remembered, and the second removes unfinished files and ends
// the process. A signal that was ignored when the command started (nohup) stays ignored. A pipe whose reader has gone
// (a `tee` that took the same Ctrl-C) does not end the process. One at a time.
class InterruptGuard {
  public:
    // `announce`: say on stderr, at the first signal, what happens now.
    explicit InterruptGuard(bool announce);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    // Number of the first signal, 0 if there was none. Callable from any thread.
    int signal() const;

  private:
    static constexpr std::array<int, 3> handled = {SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, handled.size()> previous_{};
    struct sigaction previous_pipe_ {};
};

}  // namespace keyhole
