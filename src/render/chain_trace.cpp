#include "render/chain_trace.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/bootstrap.h"
#include "render/chain_worker.h"

namespace keyhole {
namespace {

struct NoFilm {
    void splat(const PssState&, double) {}
};

constexpr const char* colours[] = {"#1f5fa8", "#c8442b", "#2f8f4e", "#8a4fb0", "#b8860b", "#3a9fb5"};
constexpr const char* rejected_colour = "#999999";

// Where a number of the image's or the steps' range lies on paper.
struct Scale {
    double from, to, begin, end;
    double operator()(double v) const { return begin + (v - from) / (to - from) * (end - begin); }
};

std::string frame(const Scale& x, const Scale& y, const std::string& title) {
    const double left = std::min(x.begin, x.end), top = std::min(y.begin, y.end);
    return fmt::format(
        R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#999"/><text x="{:.1f}" y="{:.1f}">{}</text>)",
        left, top, std::abs(x.end - x.begin), std::abs(y.end - y.begin), left, top - 6, title);
}

std::string dot(double x, double y, double radius, const char* colour) {
    return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}"/>)", x, y, radius, colour);
}

std::string in_image(const ChainTrace& trace, const Scale& x, const Scale& y) {
    std::string s = fmt::format(R"(<polyline points="{:.1f},{:.1f})", x(trace.start.x()), y(trace.start.y()));
    for (const TraceStep& step : trace.steps)
        if (step.accepted) s += fmt::format(" {:.1f},{:.1f}", x(step.position.x()), y(step.position.y()));
    s += R"(" fill="none" stroke="#d8a060" stroke-width="0.6"/>)";
    for (const TraceStep& step : trace.steps) {
        if (step.rejected_at) s += dot(x(step.rejected_at->x()), y(step.rejected_at->y()), 0.9, rejected_colour);
        if (step.accepted)
            s += dot(x(step.position.x()), y(step.position.y()), 1.3, colours[step.strategy % std::size(colours)]);
    }
    return s;
}

std::string over_time(const ChainTrace& trace, int axis, const Scale& steps, const Scale& value) {
    std::string s = fmt::format(R"(<polyline points="{:.1f},{:.1f})", steps(0), value(trace.start[axis]));
    for (std::size_t i = 0; i < trace.steps.size(); ++i)
        s += fmt::format(" {:.1f},{:.1f}", steps(static_cast<double>(i + 1)), value(trace.steps[i].position[axis]));
    return s + R"(" fill="none" stroke="#1f5fa8" stroke-width="0.7"/>)";
}

}  // namespace

ChainTrace trace_chain(const Scene& scene, const RenderSettings& settings, std::uint64_t mutations) {
    const RenderSettings resolved = resolve(scene, settings);
    const Mix& mix = resolved.mix;
    const CoordinateLayout layout(scene, mix.lengths.max);
    TechniqueDistribution techniques = make_techniques(mix);
    Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, mix);
    ChainTrace trace;
    trace.width = scene.film().width;
    trace.height = scene.film().height;
    for (const MixStrategy* s : applicable_strategies(mix, scene)) trace.strategies.push_back(s->label);
    if (bootstrap.groups.empty()) return trace;
    ChainWorker worker(scene, layout, techniques, mix, bootstrap.groups.size());
    RunningChain chain = std::move(start_chains(bootstrap.groups, mix.seed).front());
    trace.start = chain.chain.current().raster;
    NoFilm film;
    for (std::uint64_t i = 0; i < mutations; ++i) {
        const StepOutcome outcome = chain.chain.step(worker.mixture, chain.rng, film, worker.diagnostics);
        TraceStep step{chain.chain.current().raster, outcome.accepted, std::nullopt, outcome.strategy};
        if (!outcome.idle && !outcome.accepted && outcome.failure == Failure::none)
            step.rejected_at = chain.chain.proposed(outcome).raster;
        trace.steps.push_back(step);
    }
    return trace;
}

std::string trace_svg(const ChainTrace& trace, const std::string& title) {
    constexpr double width = 1100, image_width = 560, left = 20, top = 64, gap = 40;
    const double image_height = image_width * trace.height / trace.width, plot_height = (image_height - gap) / 2;
    const double height = top + std::max(image_height, 2 * 120.0 + gap) + 30;
    const Scale x{0, double(trace.width), left, left + image_width},
        y{0, double(trace.height), top, top + image_height};
    const double plot_left = left + image_width + gap, tall = std::max(plot_height, 120.0);
    const Scale steps{0, std::max(1.0, double(trace.steps.size())), plot_left, width - 20};
    const Scale over_x{0, double(trace.width), top + tall, top};
    const Scale over_y{0, double(trace.height), top + tall + gap, top + 2 * tall + gap};
    std::string s = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1:.0f}" viewBox="0 0 {0} {1:.0f}" font-family="sans-serif" font-size="11"><rect width="{0}" height="{1:.0f}" fill="white"/><text x="{2}" y="20" font-size="14">{3}</text>)",
        width, height, left, title);
    double at = left;
    for (std::size_t i = 0; i <= trace.strategies.size(); ++i) {
        const bool last = i == trace.strategies.size();
        const std::string label = last ? "rejected" : trace.strategies[i];
        s += dot(at + 3, 36, 3, last ? rejected_colour : colours[i % std::size(colours)]);
        s += fmt::format(R"(<text x="{}" y="40">{}</text>)", at + 10, label);
        at += 30 + 6.5 * static_cast<double>(label.size());
    }
    s += frame(x, y, "in the image") + in_image(trace, x, y);
    s += frame(steps, over_x, fmt::format("x over {} mutations", trace.steps.size())) +
         over_time(trace, 0, steps, over_x);
    s += frame(steps, over_y, "y, downwards as in the image") + over_time(trace, 1, steps, over_y);
    return s + "</svg>\n";
}

}  // namespace keyhole
