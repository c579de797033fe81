// What a mutation is made of, on each of the project's own scenes: rays, charts, and whole steps of a chain.
#include <benchmark/benchmark.h>

#include "own_scenes.h"
#include "render/bootstrap.h"
#include "render/chain_worker.h"
#include "render/render.h"
#include "strategies/with_unused.h"

namespace keyhole {
namespace {

constexpr int film_size = 256, max_length = 8;

// Paths of two edges and more, as `keyhole bench` has them: those of one edge cost next to nothing.
const TechniqueDistribution every_technique(2, max_length);

std::unique_ptr<Scene> load(const std::string& name) { return own_scene(name, film_size, film_size); }

// Rays of one kind that large steps cast, in their order.
std::vector<Ray> rays_of_large_steps(const Scene& scene, bool occlusion) {
    const CoordinateLayout layout(scene, max_length);
    ChartEvaluator evaluator(scene, layout);
    const LargeStep large(evaluator, every_technique);
    PssState state(layout);
    std::vector<RecordedRay> recorded;
    evaluator.tracer().record_into(&recorded);
    Rng rng(1);
    for (int i = 0; i < 20000; ++i) large.draw(state, rng);
    std::vector<Ray> rays;
    for (const RecordedRay& r : recorded)
        if (r.occlusion == occlusion) rays.push_back(r.ray);
    return rays;
}

template <bool occlusion>
void cast(benchmark::State& state, const std::string& name) {
    const auto scene = load(name);
    const std::vector<Ray> rays = rays_of_large_steps(*scene, occlusion);
    SurfacePoint hit;
    std::size_t i = 0;
    for (auto _ : state) {
        const Ray& ray = rays[i];
        if (++i == rays.size()) i = 0;
        if constexpr (occlusion)
            benchmark::DoNotOptimize(scene->unoccluded(ray));
        else
            benchmark::DoNotOptimize(scene->intersect(ray, hit));
    }
}

// Charts of all techniques, uniform coordinates; drawing those is part of it.
void evaluate_chart(benchmark::State& state, const std::string& name) {
    const auto scene = load(name);
    const CoordinateLayout layout(*scene, max_length);
    ChartEvaluator evaluator(*scene, layout);
    const LargeStep large(evaluator, every_technique);
    PssState drawn(layout);
    Rng rng(1);
    for (auto _ : state) benchmark::DoNotOptimize(large.draw(drawn, rng));
}

// A worker and chains of a mix, as `keyhole render` has them.
struct Run {
    Run(const Scene& scene, const Mix& mix, int chain_count) : layout(scene, max_length), techniques(every_technique) {
        settings.mutations_per_pixel = 1;
        settings.mix = mix;
        settings.mix.lengths = {2, max_length};
        settings.mix.chain_count = chain_count;
        settings = resolve(scene, settings);
        Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, settings.mix);
        chains = start_chains(bootstrap.groups, settings.mix.seed);
        worker = std::make_unique<ChainWorker>(scene, layout, techniques, settings.mix, bootstrap.groups.size());
    }
    RenderSettings settings;
    CoordinateLayout layout;
    TechniqueDistribution techniques;
    std::vector<RunningChain> chains;
    std::unique_ptr<ChainWorker> worker;
};

// Steps of a mixture with their splats.
void mutate(benchmark::State& state, const std::string& name, const Mix& mix) {
    const auto scene = load(name);
    Run run(*scene, mix, 1);
    for (auto _ : state) run.worker->advance(run.chains.front(), 1);
}

// Proposals of one strategy of the mix cmlt, from many states in equilibrium.
void propose(benchmark::State& state, const std::string& name, const std::string& strategy) {
    const auto scene = load(name);
    Run run(*scene, builtin_mix("cmlt"), 1024);
    for (RunningChain& chain : run.chains) run.worker->advance(chain, 200);
    std::size_t index = 0;
    while (run.worker->mixture.strategy(index).name() != strategy) ++index;
    PssState y = run.worker->evaluator->make_state();
    Rng rng(1);
    std::size_t i = 0;
    for (auto _ : state) {
        PssState& x = run.chains[i++ % run.chains.size()].chain.current();
        benchmark::DoNotOptimize(run.worker->mixture.strategy(index).propose(x, y, rng));
    }
}

const bool added = [] {
    for (const std::string& name : own_scene_names()) {
        if (name == "four-holes") continue;  // paths of one edge only
        benchmark::RegisterBenchmark(("intersect/" + name).c_str(), cast<false>, name);
        benchmark::RegisterBenchmark(("unoccluded/" + name).c_str(), cast<true>, name);
        benchmark::RegisterBenchmark(("chart_evaluate/" + name).c_str(), evaluate_chart, name);
        benchmark::RegisterBenchmark(("mutation/" + name).c_str(), mutate, name, builtin_mix("mmlt"));
        benchmark::RegisterBenchmark(("mutation-unused/" + name).c_str(), mutate, name,
                                     with_unused(builtin_mix("mmlt")));
        for (const std::string strategy : {"large-step", "small-step", "chart-swap"})
            benchmark::RegisterBenchmark((strategy + "/" + name).c_str(), propose, name, strategy);
    }
    return true;
}();

}  // namespace
}  // namespace keyhole
