#include "base/phase.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace keyhole {
namespace {

using Clock = std::chrono::steady_clock;

// Returns how long it took: more than asked for where the machine is busy.
double work(Phase phase, std::chrono::microseconds time) {
    const PhaseScope scope(phase);
    const auto start = Clock::now();
    while (Clock::now() < start + time) {
    }
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double share(const PhaseSampler::Counts& counts, Phase phase) {
    double sum = 0;
    for (std::size_t i = 1; i < counts.size(); ++i) sum += static_cast<double>(counts[i]);
    return static_cast<double>(counts[static_cast<std::size_t>(phase)]) / sum;
}

// About three quarters of the time in one phase, a quarter in another. 1,000 looks in two seconds, at both threads: the
// share is off by a tenth with a chance below 1e-8, and less often than that even if only every fifth look is made. The
// phases are short against a thread's turns on a busy machine, with which the looks fall together.
TEST(PhaseSampler, SeesWhatThreadsDo) {
    const PhaseSampler sampler;
    std::array<double, 2> tracing{}, shading{};
    const auto body = [&](std::size_t i) {
        const WorkScope scope(Phase::shading);
        for (const auto end = Clock::now() + std::chrono::seconds(2); Clock::now() < end;) {
            tracing[i] += work(Phase::tracing, std::chrono::microseconds(300));
            shading[i] += work(Phase::shading, std::chrono::microseconds(100));
        }
    };
    std::thread a(body, 0), b(body, 1);
    a.join();
    b.join();
    const double expected = (tracing[0] + tracing[1]) / (tracing[0] + tracing[1] + shading[0] + shading[1]);
    const PhaseSampler::Counts counts = sampler.counts();
    EXPECT_NEAR(share(counts, Phase::tracing), expected, 0.1);
    EXPECT_NEAR(share(counts, Phase::shading), 1 - expected, 0.1);
    EXPECT_EQ(counts[static_cast<std::size_t>(Phase::cones)], 0u);
}

TEST(PhaseSampler, ForgetsThreadsThatHaveEnded) {
    std::thread([] { const WorkScope scope(Phase::film); }).join();
    const PhaseSampler sampler;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(sampler.counts()[static_cast<std::size_t>(Phase::film)], 0u);
}

// As TBB's do: the address sanitizer sees a thread that leaves what is gone.
TEST(PhaseSamplerDeathTest, ThreadsMayEndAfterAllThatIsStatic) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto exit_before_the_thread = [] {
        static std::atomic<bool> working = false, ending = false, ended = false;
        static const struct Last {
            ~Last() {
                ending = true;
                while (!ended) std::this_thread::yield();
            }
        } last;
        struct Ended {
            ~Ended() { ended = true; }
        };
        std::thread([] {
            thread_local const Ended after_its_scope;
            const WorkScope scope(Phase::film);
            working = true;
            while (!ending) std::this_thread::yield();
        }).detach();
        while (!working) std::this_thread::yield();
        std::exit(0);
    };
    EXPECT_EXIT(exit_before_the_thread(), testing::ExitedWithCode(0), "");
}

TEST(PhaseScope, ReturnsToWhatWasBefore) {
    const PhaseScope outer(Phase::shading);
    {
        const PhaseScope inner(Phase::tracing);
        EXPECT_EQ(current_phase.load(), Phase::tracing);
    }
    EXPECT_EQ(current_phase.load(), Phase::shading);
}

}  // namespace
}  // namespace keyhole
