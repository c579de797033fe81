#include "strategies/caustic.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

CausticPerturbation::CausticPerturbation(ChartEvaluator& charts, std::unique_ptr<const StepSize> size,
                                         const RasterStep& raster, double roughness)
    : Perturbation(charts, roughness), size_(std::move(size)), raster_(resolved(raster)) {}

DirectionKernel CausticPerturbation::kernel(const PssState& x, int start) const {
    const auto v = [&](int i) -> const Vertex& { return at(x, i); };
    if (!raster_.used) return (*size_)(v(start), v(start - 1));
    // The view of x_1, which lies on the film, as x has a measure.
    const auto view = scene().sensor().view(sensor_point(v(0)), v(1).x.p);
    const double distance = v(0).infinite ? 1 : (v(1).x.p - v(0).x.p).norm();
    double chain = 0;
    for (int i = 1; i < start; ++i) chain += (v(i + 1).x.p - v(i).x.p).norm();
    const double angle_per_pixel = distance / (std::sqrt(view->raster_per_measure) * chain);
    const double r_max = std::min(raster_.r_max * angle_per_pixel, 0.5 * pi);
    return {std::min(raster_.r_min * angle_per_pixel, 0.5 * r_max), r_max};
}

int CausticPerturbation::start(const PssState& x) const {
    const PathMeasure* m = charts_.measure(x);
    const int k = x.path.k;
    if (!m || k < 3 || specular(*m, 1)) return 0;
    int j = 2;
    while (j < k && specular(*m, j)) ++j;
    return j > 2 && !at(x, j).infinite ? j : 0;
}

Failure CausticPerturbation::retrace(const PssState& x, PssState& y, int start_index, Rng& rng) const {
    for (int i = start_index; i > 1; --i) {
        const Failure failure = i == start_index ? perturb(x, y, i, -1, kernel(x, i), rng) : follow(x, y, i, -1, rng);
        if (failure != Failure::none) return failure;
    }
    const Vertex* const v = y.path.room.data();
    if (!connectable(v[1])) return Failure::zero_bsdf;
    if (const PathFailure failure = charts_.complete(y); failure != PathFailure::none) return to_failure(failure);
    if (start(y) != start_index) return Failure::outside_support;
    return visible(tracer(), v[0], v[1]) ? Failure::none : Failure::occluded;
}

Proposal CausticPerturbation::propose(PssState& x, PssState& y, Rng& rng) const {
    const int j = start(x);
    keep(x, y);
    if (const Failure failure = retrace(x, y, j, rng); failure != Failure::none) return Proposal::failed(failure);
    Densities densities;
    add_perturbed(x, y, j, -1, kernel(x, j), kernel(y, j), densities);
    for (int i = j - 1; i > 1; --i) add_followed(x, y, i, -1, densities);
    return proposal(x, y, densities.forth, densities.back);
}

}  // namespace keyhole
