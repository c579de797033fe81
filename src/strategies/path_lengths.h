// Lengths of paths, as a mix has them.
#pragma once

namespace keyhole {

// Which paths a chain moves among.
struct PathLengths {
    static constexpr int longest = 256;

    int min = 1, max = 0;  // edges; max 0: what the scene file says, else 12
    bool fixed = false;    // each chain keeps the length that it started with

    bool operator==(const PathLengths&) const = default;
};

}  // namespace keyhole
