// Where one chain goes in the image, step by step [Otsu et al. 2018, figure 5; 2020, figure 4].
#pragma once

#include <string>
#include <vector>

#include "render/render.h"

namespace keyhole {

struct TraceStep {
    Vec2 position;                    // of the chain after the step, in the image
    bool accepted = false;            // the step moved it
    std::optional<Vec2> rejected_at;  // where a proposal would have gone, if it had a path
    std::size_t strategy = 0;         // index in `strategies`
};

struct ChainTrace {
    Vec2 start{0, 0};
    std::vector<TraceStep> steps;
    std::vector<std::string> strategies;  // labels
    int width = 0, height = 0;            // of the film
};

// The first chain of a render with these settings. Without steps if no path carries light.
ChainTrace trace_chain(const Scene& scene, const RenderSettings& settings, std::uint64_t mutations);

// The way through the image, and x and y over the steps.
std::string trace_svg(const ChainTrace& trace, const std::string& title);

}  // namespace keyhole
