#include "render/unbiased.h"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>

#include "base/parallel.h"
#include "base/phase.h"
#include "render/run_control.h"
#include "render/samplers.h"

namespace keyhole {
namespace {

std::unique_ptr<Sampler> make_sampler(const Scene& scene, const RenderSettings& settings) {
    const LengthRange lengths{settings.mix.lengths.min, settings.mix.lengths.max};
    if (settings.integrator == Integrator::path) return std::make_unique<PathSampler>(scene, lengths);
    return std::make_unique<BdptSampler>(scene, lengths);
}

struct Worker {
    std::unique_ptr<Sampler> sampler;
    RadianceFilm film;
};

}  // namespace

RenderResult render_unbiased(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks) {
    const FilmSettings& film = scene.film();
    const RasterWindow window(film);
    // One sample of a unit falls into each cell of a grid over the window, at a random place.
    const int columns = static_cast<int>(std::ceil(window.size.x())),
              rows = static_cast<int>(std::ceil(window.size.y()));
    const std::uint64_t per_unit = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
    const auto budget = static_cast<std::uint64_t>(std::ceil(settings.mutations_per_pixel));
    RunControl control(settings, callbacks, budget, per_unit);
    tbb::enumerable_thread_specific<Worker> workers([&] {
        return Worker{make_sampler(scene, settings), RadianceFilm(film)};
    });

    auto sample_row = [&](std::uint64_t unit, int row) {
        const WorkScope work(Phase::shading);
        Worker& worker = workers.local();
        Rng rng(settings.mix.seed, unit * static_cast<std::uint64_t>(rows) + static_cast<std::uint64_t>(row));
        for (int column = 0; column < columns; ++column) {
            const double u = rng.uniform(), v = rng.uniform();
            worker.sampler->sample(window.at({(column + u) / columns, (row + v) / rows}), rng, worker.film);
        }
    };
    auto develop = [&] {
        RadianceFilm sum(film);
        for (const Worker& worker : workers) sum.merge(worker.film);
        return sum.develop(1 / static_cast<double>(per_unit * control.done()));
    };

    while (const std::uint64_t units = control.next_pass()) {
        parallel_for(units * rows,
                     [&](std::uint64_t job) { sample_row(control.done() + job / rows, static_cast<int>(job % rows)); });
        control.finished(units, -1, develop);
    }

    RenderResult result;
    result.image = develop();
    RenderStatistics& s = result.statistics;
    control.report(s);
    for (const Worker& worker : workers) {
        s.rays += worker.sampler->tracer().rays();
        s.non_finite += worker.sampler->non_finite();
    }
    return result;
}

}  // namespace keyhole
