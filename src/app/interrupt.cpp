#include "app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "app/command.h"
#include "base/atomic_file.h"

namespace keyhole {
namespace {

std::atomic<int> first_signal{0};
std::atomic<bool> announce_first{false};

void on_signal(int number) {
    int none = 0;
    if (!first_signal.compare_exchange_strong(none, number)) {
        remove_unfinished_files();
        _exit(exit_signal + number);
    }
    static constexpr char text[] = "\nkeyhole: finishing the current pass; once more ends at once, without the image\n";
    const int saved_errno = errno;
    if (announce_first.load() && write(STDERR_FILENO, text, sizeof(text) - 1) < 0) errno = saved_errno;
}

}  // namespace

InterruptGuard::InterruptGuard(bool announce) {
    first_signal.store(0);
    announce_first.store(announce);
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < handled.size(); ++i) {
        sigaction(handled[i], nullptr, &previous_[i]);
        if (previous_[i].sa_handler != SIG_IGN) sigaction(handled[i], &action, nullptr);
    }
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, &previous_pipe_);
}

InterruptGuard::~InterruptGuard() {
    for (std::size_t i = 0; i < handled.size(); ++i) sigaction(handled[i], &previous_[i], nullptr);
    sigaction(SIGPIPE, &previous_pipe_, nullptr);
}

int InterruptGuard::signal() const { return first_signal.load(); }

}  // namespace keyhole
