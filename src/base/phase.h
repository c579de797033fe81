// What the time of a render goes into: threads mark what they do, and a sampler looks at them now and then.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

namespace keyhole {

enum class Phase : unsigned char { idle, tracing, shading, inversion, cones, film, other };
inline constexpr std::array<const char*, 7> phase_names = {"idle",  "tracing", "shading", "inversion",
                                                           "cones", "film",    "other"};

// Of this thread.
inline constinit thread_local std::atomic<Phase> current_phase{Phase::idle};

// Marks what this thread does until the end of the scope, which costs three moves. Scopes may be nested.
class PhaseScope {
  public:
    explicit PhaseScope(Phase phase) : before_(current_phase.load(std::memory_order_relaxed)) {
        current_phase.store(phase, std::memory_order_relaxed);
    }
    ~PhaseScope() { current_phase.store(before_, std::memory_order_relaxed); }
    PhaseScope(const PhaseScope&) = delete;
    PhaseScope& operator=(const PhaseScope&) = delete;

  private:
    Phase before_;
};

// The same for a long piece of work, from which on samplers see this thread.
class WorkScope {
  public:
    explicit WorkScope(Phase phase);

  private:
    PhaseScope scope_;
};

// While one exists, looks at all threads that have begun a WorkScope, every two milliseconds, from a thread of its own.
class PhaseSampler {
  public:
    using Counts = std::array<std::size_t, phase_names.size()>;

    PhaseSampler();
    ~PhaseSampler();
    PhaseSampler(const PhaseSampler&) = delete;
    PhaseSampler& operator=(const PhaseSampler&) = delete;

    // How often a thread was seen in each phase.
    Counts counts() const;

  private:
    struct Looker;
    std::unique_ptr<Looker> looker_;
};

}  // namespace keyhole
