// What needs no scene: random numbers, warps, step kernels, the film.
#include <benchmark/benchmark.h>

#include "base/warp.h"
#include "inputs.h"
#include "pss/kernels.h"
#include "render/film.h"

namespace keyhole {
namespace {

void random_uniform(benchmark::State& state) {
    Rng rng(1);
    for (auto _ : state) benchmark::DoNotOptimize(rng.uniform());
}
BENCHMARK(random_uniform);

void random_lane_words(benchmark::State& state) {
    Rng rng(1);
    for (auto _ : state) benchmark::DoNotOptimize(*rng.bits(lanes));
}
BENCHMARK(random_lane_words);

// A step of as many coordinates as an eye subpath of eight vertices has.
template <class Kernel>
void step(benchmark::State& state) {
    const Kernel kernel;
    constexpr int n = 20;
    Rng rng(1);
    double x[whole_lanes(n)], y[whole_lanes(n)];
    for (double& c : x) c = rng.uniform();
    for (auto _ : state) {
        kernel(x, y, n, rng);
        benchmark::DoNotOptimize(y);
    }
    state.SetItemsProcessed(state.iterations() * n);
}
BENCHMARK_TEMPLATE(step, KelemenKernel);
BENCHMARK_TEMPLATE(step, GaussianKernel);

template <class Warp>
void warp(benchmark::State& state, const Warp& to_domain) {
    Inputs<Vec2> u(uniform2);
    for (auto _ : state) benchmark::DoNotOptimize(to_domain(u.next()));
}
const Bilinear corners{1, 2, 3, 4};
BENCHMARK_CAPTURE(warp, disk, [](const Vec2& u) { return square_to_disk(u); });
BENCHMARK_CAPTURE(warp, cosine_hemisphere, [](const Vec2& u) { return square_to_cosine_hemisphere(u); });
BENCHMARK_CAPTURE(warp, sphere, [](const Vec2& u) { return square_to_sphere(u); });
BENCHMARK_CAPTURE(warp, cone, [](const Vec2& u) { return square_to_cone(u, 0.9); });
BENCHMARK_CAPTURE(warp, cosine_power, [](const Vec2& u) { return square_to_cosine_power(u, 30); });
BENCHMARK_CAPTURE(warp, triangle, [](const Vec2& u) { return square_to_triangle(u); });
BENCHMARK_CAPTURE(warp, bilinear, [](const Vec2& u) { return square_to_bilinear(u, corners); });

// Splats all over a film that is larger than the caches.
template <class Film>
Film large_film(const ReconstructionFilter& filter) {
    FilmSettings settings;
    settings.width = settings.crop_width = settings.height = settings.crop_height = 1024;
    settings.filter = filter;
    return Film(settings);
}

template <class Film>
void splat(benchmark::State& state, Film film) {
    Inputs<Vec2> at([](Rng& rng) -> Vec2 { return 1024 * uniform2(rng); });
    for (auto _ : state) film.splat(at.next(), {0.1, 0.2, 0.3});
}
BENCHMARK_CAPTURE(splat, metropolis_box, large_film<MetropolisFilm>(make_box_filter()));
BENCHMARK_CAPTURE(splat, metropolis_tent, large_film<MetropolisFilm>(make_tent_filter()));
BENCHMARK_CAPTURE(splat, metropolis_gaussian, large_film<MetropolisFilm>(make_gaussian_filter()));
BENCHMARK_CAPTURE(splat, radiance_box, large_film<RadianceFilm>(make_box_filter()));

}  // namespace
}  // namespace keyhole
