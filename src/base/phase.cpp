#include "base/phase.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace keyhole {
namespace {

// The phases of the threads that can be seen.
struct Threads {
    std::mutex mutex;
    std::vector<const std::atomic<Phase>*> phases;
};

// Never destroyed, as TBB's threads may end after all that is static.
Threads& threads() {
    static Threads& all = *new Threads;
    return all;
}

// Enters this thread, for as long as it lives.
struct Entry {
    Entry() {
        const std::lock_guard lock(threads().mutex);
        threads().phases.push_back(&current_phase);
    }
    ~Entry() {
        const std::lock_guard lock(threads().mutex);
        std::erase(threads().phases, &current_phase);
    }
};

}  // namespace

WorkScope::WorkScope(Phase phase) : scope_(phase) { [[maybe_unused]] thread_local const Entry entry; }

struct PhaseSampler::Looker {
    mutable std::mutex mutex;
    std::condition_variable wake;
    bool ended = false;
    Counts counts{};
    std::thread thread;

    void look() {
        std::unique_lock lock(mutex);
        while (!wake.wait_for(lock, std::chrono::milliseconds(2), [this] { return ended; })) {
            const std::lock_guard all(threads().mutex);
            for (const std::atomic<Phase>* phase : threads().phases)
                ++counts[static_cast<std::size_t>(phase->load(std::memory_order_relaxed))];
        }
    }
};

PhaseSampler::PhaseSampler() : looker_(std::make_unique<Looker>()) {
    looker_->thread = std::thread([this] { looker_->look(); });
}

PhaseSampler::~PhaseSampler() {
    {
        const std::lock_guard lock(looker_->mutex);
        looker_->ended = true;
    }
    looker_->wake.notify_one();
    looker_->thread.join();
}

PhaseSampler::Counts PhaseSampler::counts() const {
    const std::lock_guard lock(looker_->mutex);
    return looker_->counts;
}

}  // namespace keyhole
