// What a strategy answers when it is asked for a proposal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace keyhole {

// Why there is no proposal. The chain treats all kinds alike (the current state is counted once more); they are told
// apart for the statistics.
enum class Failure : std::uint8_t {
    none,
    eye_subpath_short,    // the path from the sensor ended before it had enough vertices
    light_subpath_short,  // the path from the emitter did
    occluded,             // the connection is blocked
    zero_bsdf,            // a vertex passes nothing on in these directions
    outside_film,
    outside_support,  // the reverse move could not have proposed the current state
    inverse_failed,   // no coordinates were found for the path, or they do not lead back to it
    non_finite,       // a NaN or an infinity: a bug, counted apart so that it is seen
    unchanged,        // the proposal is the current state itself
    other,
};

inline constexpr std::array<std::string_view, 11> failure_names = {
    "none",         "eye subpath short", "light subpath short", "occluded",   "zero bsdf",
    "outside film", "outside support",   "inverse failed",      "non-finite", "unchanged",
    "other"};
inline constexpr std::size_t failure_kinds = failure_names.size();

inline std::string_view failure_name(Failure failure) { return failure_names[static_cast<std::size_t>(failure)]; }

// Whether there is a proposed state, which contributes nothing or may not be moved to.
inline bool lacks_contribution(Failure failure) { return failure != Failure::none && failure != Failure::unchanged; }

// A proposed state's Metropolis-Hastings ratio, pi(y) q(y -> x) / (pi(x) q(x -> y)), without the probabilities of
// choosing the strategy, which the mixture adds. In [0, inf); above one it is accepted for sure.
struct Proposal {
    double ratio = 0;
    Failure failure = Failure::none;        // other than `none`: there is no proposed state, and the ratio is not read
    Failure first_failure = Failure::none;  // other than `none`: a first stage failed, and this is of a second one

    static Proposal failed(Failure failure) { return {0, failure}; }
};

// The probability of accepting a proposal. A ratio that is negative, infinite or NaN makes it one that failed.
inline double acceptance(Proposal& proposal) {
    if (proposal.failure != Failure::none) return 0;
    if (proposal.ratio >= 0 && proposal.ratio <= std::numeric_limits<double>::max())
        return proposal.ratio < 1 ? proposal.ratio : 1;
    proposal.failure = Failure::non_finite;
    return 0;
}

}  // namespace keyhole
