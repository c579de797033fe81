// Counts of what the steps of chains came to, for each strategy of a mixture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "chain/outcome.h"

namespace keyhole {

// Of one stage of a strategy's proposals. Sums are integers: adding up the counts of any number of threads gives the
// same result in any order.
struct StageCounts {
    static constexpr double acceptance_unit = 0x1p-24;  // of acceptance_sum; enough for 10^12 proposals

    std::uint64_t proposals = 0;  // including failed ones
    std::uint64_t accepted = 0;
    std::uint64_t acceptance_sum = 0;                     // of the acceptance probabilities, in acceptance_unit
    std::array<std::uint64_t, failure_kinds> failures{};  // by kind; at `none`: proposals that did not fail

    void add(Failure failure, double acceptance, bool was_accepted) {
        ++proposals;
        ++failures[static_cast<std::size_t>(failure)];
        accepted += was_accepted;
        acceptance_sum += static_cast<std::uint64_t>(acceptance * (1 / acceptance_unit) + 0.5);
    }
    StageCounts& operator+=(const StageCounts& other) {
        proposals += other.proposals;
        accepted += other.accepted;
        acceptance_sum += other.acceptance_sum;
        for (std::size_t i = 0; i < failure_kinds; ++i) failures[i] += other.failures[i];
        return *this;
    }
    bool operator==(const StageCounts&) const = default;

    std::uint64_t failed(Failure kind) const { return failures[static_cast<std::size_t>(kind)]; }
};

// Of steps. Failures are those of first stages; acceptances those of both.
struct StrategyCounts : StageCounts {
    std::uint64_t excluded = 0;  // of the proposals: those that failed and were no steps (Rectification::exclude)
    StageCounts second;          // of second stages: of the first ones that failed, those that were followed by one

    void add(Failure failure, double acceptance, bool was_accepted, Failure first_failure = Failure::none) {
        const bool two_stages = first_failure != Failure::none;
        StageCounts::add(two_stages ? first_failure : failure, acceptance, was_accepted);
        if (two_stages) second.add(failure, acceptance, was_accepted);
    }
    void exclude(Failure failure) {
        StageCounts::add(failure, 0, false);
        ++excluded;
    }
    StrategyCounts& operator+=(const StrategyCounts& other) {
        StageCounts::operator+=(other);
        excluded += other.excluded;
        second += other.second;
        return *this;
    }

    // Mean acceptance probability of all steps, failed ones included; 0 without steps.
    double mean_acceptance() const {
        const std::uint64_t steps = proposals - excluded;
        return steps ? static_cast<double>(acceptance_sum) * acceptance_unit / static_cast<double>(steps) : 0;
    }
    bool operator==(const StrategyCounts&) const = default;
};

struct Diagnostics {
    std::vector<StrategyCounts> strategies;  // as in the mixture
    std::uint64_t idle = 0;                  // steps at states that no strategy applies to

    explicit Diagnostics(std::size_t strategy_count = 0) : strategies(strategy_count) {}

    // Both must be of the same mixture.
    Diagnostics& operator+=(const Diagnostics& other) {
        for (std::size_t i = 0; i < strategies.size(); ++i) strategies[i] += other.strategies[i];
        idle += other.idle;
        return *this;
    }

    StrategyCounts total() const {
        StrategyCounts sum;
        for (const StrategyCounts& s : strategies) sum += s;
        return sum;
    }
    bool operator==(const Diagnostics&) const = default;
};

}  // namespace keyhole
