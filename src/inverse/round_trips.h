// How good the inverses are in a scene: paths of every technique, inverted into every other and traced again.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "inverse/inverse.h"

namespace keyhole {

inline constexpr std::array<const char*, 6> inverse_failure_names = {"none",    "impossible", "sensor",
                                                                     "emitter", "bsdf",       "retrace"};

// Of one sampler: what draws a vertex, or the direction to the next one.
struct SamplerRoundTrips {
    std::string kind, name;  // "sensor perspective", "emitter area", "bsdf roughconductor"
    std::uint64_t tries = 0;
    std::array<std::uint64_t, inverse_failure_names.size()> failures{};  // by InverseFailure
    // Of what came back: deviations as in inverse.h. The percentile counts tries.
    double worst = 0, percentile_99_9 = 0;

    std::uint64_t failed() const {
        std::uint64_t sum = 0;
        for (std::size_t i = 1; i < failures.size(); ++i) sum += failures[i];
        return sum;
    }
};

// Of the numbers of one kind: drawn ones against those that the inverse found for other paths of the same technique.
struct CoordinateTest {
    std::string name;  // "raster", "direction", "lobe", ...
    std::uint64_t numbers = 0;
    double p_value = 1;  // two-sample chi-square over 20 cells
};

struct RoundTrips {
    std::uint64_t paths = 0;       // with light, of two edges or more
    std::uint64_t negligible = 0;  // of them left out: they carry less than 1e-7 of the mean
    std::uint64_t inversions = 0, impossible = 0;
    std::vector<SamplerRoundTrips> samplers;
    std::vector<CoordinateTest> coordinates;
};

// Draws paths until `paths` are found with light, or `tries` are made. Throws std::invalid_argument for max_length < 2.
RoundTrips measure_round_trips(const Scene& scene, int max_length, std::uint64_t paths, std::uint64_t tries,
                               std::uint64_t seed);

}  // namespace keyhole
