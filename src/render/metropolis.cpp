#include "render/metropolis.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "render/chain_run.h"
#include "render/race.h"
#include "render/run_control.h"

namespace keyhole {
namespace {

// What the mix cannot do in the scene, or does wrong by intention.
void warn_of_mix(const Mix& mix, const Scene& scene, RenderStatistics& statistics) {
    for (const MixStrategy& s : mix.strategies)
        if (const std::string why = s.info->hindrance(scene, mix.lengths); s.weight > 0 && !why.empty())
            statistics.warnings.push_back(fmt::format("strategy '{}' never applies here: {}", s.label, why));
    if (mix.rectification.policy == Rectification::exclude)
        statistics.warnings.push_back(
            "biased: proposals without contribution are left out (rectification = \"exclude\"), which darkens what "
            "often fails, such as the surroundings of occluders, and brightens the rest; \"walk-on\" and \"retry\" are "
            "exact");
    if (mix.techniques.light_vertices != LightVertices::any)
        statistics.warnings.push_back(
            "only some techniques are in use (techniques.light-vertices): light that no other finds is missing");
}

}  // namespace

RenderResult render_metropolis(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const FilmSettings& film = scene.film();
    RenderSettings used = settings;  // its mix changes where it is tuned
    Mix& mix = used.mix;
    RunControl control(settings, callbacks, static_cast<std::uint64_t>(mix.chain_length),
                       static_cast<std::uint64_t>(mix.chain_count));
    RenderResult result;
    RenderStatistics& statistics = result.statistics;
    control.announce("bootstrap", 0);
    const CoordinateLayout layout(scene, mix.lengths.max);
    TechniqueDistribution techniques = make_techniques(mix);
    Bootstrap bootstrap = run_bootstrap(scene, layout, techniques, mix);
    statistics.seconds_bootstrap = control.elapsed();
    statistics.rays = bootstrap.rays;
    statistics.non_finite = bootstrap.non_finite;
    if (bootstrap.groups.empty()) {
        warn_of_mix(mix, scene, statistics);
        result.image = result.error = Image(film.crop_width, film.crop_height);
        statistics.cpu_seconds = control.elapsed_cpu();
        statistics.warnings.push_back("no bootstrap path carries light: the image is black");
        return result;
    }

    if (mix.tuning == Mix::Tuning::race) {
        const auto stop = [&](double share) {
            control.announce("tuning", std::min(1.0, share));
            return callbacks.stop && callbacks.stop();
        };
        const RaceLength length = RaceLength::of(settings, tbb::this_task_arena::max_concurrency());
        RaceResult result_of_race = race(scene, settings, layout, techniques, bootstrap, length, stop);
        mix = std::move(result_of_race.mix);
        statistics.tuning = std::move(result_of_race.statistics);
        statistics.seconds_bootstrap = control.elapsed();
        for (ChainGroup& group : bootstrap.groups)
            for (ChainSeed& seed : group.seeds) fit_state(seed.state, mix);
    }
    warn_of_mix(mix, scene, statistics);

    ChainRun run(scene, used, layout, techniques, std::move(bootstrap));
    while (const std::uint64_t pass = control.next_pass()) {
        const std::uint64_t mutations = run.advance(pass);
        control.finished(mutations, run.diagnostics().total().mean_acceptance(), [&] { return run.develop(); });
    }

    result.image = run.develop();
    if (settings.error_image) result.error = run.develop_errors();
    control.report(statistics);
    statistics.mix = mix;
    run.report(applicable_strategies(mix, scene), statistics);
    return result;
}

}  // namespace keyhole
