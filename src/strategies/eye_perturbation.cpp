#include "strategies/eye_perturbation.h"

#include <cmath>

#include "pathspace/neighbours.h"

namespace keyhole {

EyePerturbation::EyePerturbation(ChartEvaluator& charts, Chains chains, std::unique_ptr<const StepSize> size,
                                 double roughness, const RasterStep& raster)
    : Perturbation(charts, roughness), chains_(chains), size_(std::move(size)), raster_(resolved(raster)) {}

EyePerturbation::Structure EyePerturbation::structure(const PssState& x) const {
    const PathMeasure* m = charts_.measure(x);
    if (!m) return {};
    const int k = x.path.k;
    for (int chains = 1, i = 1;; ++chains, ++i) {
        while (i < k && specular(*m, i)) ++i;
        // Reached by the chain itself: an emitter that rays cannot hit is not.
        if (i == k) return m->eye[static_cast<std::size_t>(k)] > 0 ? Structure{chains, k} : Structure{};
        if (i + 1 == k || !specular(*m, i + 1)) return {chains, i};
    }
}

DirectionKernel EyePerturbation::kernel(const PssState& x, int i) const { return (*size_)(at(x, i), at(x, i + 1)); }

double EyePerturbation::suitability(const PssState& x) const {
    // All primary rays of an orthographic sensor are parallel.
    if (!raster_.used && scene().sensor().traits().infinite) return 0;
    const int chains = structure(x).chains;
    return (chains_ == Chains::one ? chains == 1 : chains > 1) ? 1 : 0;
}

std::optional<Vec2> EyePerturbation::primary_raster(const PssState& x, Rng& rng) const {
    const double first = rng.uniform();
    const Vec2 u(first, rng.uniform());
    const Vertex &x0 = x.path.room[0], &x1 = x.path.room[1];
    if (!raster_.used)
        return scene().sensor().raster_towards(sensor_point(x0), kernel(x, 0).sample(direction(x0, x1), u));
    const double r = raster_.r_max * std::pow(raster_.r_min / raster_.r_max, u.x()), phi = 2 * pi * u.y();
    return x.measure.raster + r * Vec2(std::cos(phi), std::sin(phi));
}

Failure EyePerturbation::perturb_primary(const PssState& x, PssState& y, Rng& rng) const {
    const std::optional<Vec2> raster = primary_raster(x, rng);
    if (!raster || !window().contains(*raster)) return Failure::outside_film;
    Vertex* const v = y.path.room.data();
    const Extension e = first_eye_edge(tracer(), window(), *raster, v[0], v[1]);
    return arrived(y, 0, 1, e);
}

Failure EyePerturbation::walk(const PssState& x, PssState& y, int end, Rng& rng) const {
    for (int i = 0; i < end; ++i) {
        const Failure failure = i == 0                   ? perturb_primary(x, y, rng)
                                : specular(x.measure, i) ? follow(x, y, i, 1, rng)
                                                         : perturb(x, y, i, 1, kernel(x, i), rng);
        if (failure != Failure::none) return failure;
    }
    if (end < y.path.k && !connectable(at(y, end))) return Failure::zero_bsdf;
    return Failure::none;
}

bool EyePerturbation::same_structure(const PssState& x, const PssState& y, const Structure& of_x) const {
    if (structure(y) != of_x) return false;
    for (int i = 1; i < of_x.end; ++i)
        if (specular(y.measure, i) != specular(x.measure, i)) return false;
    return true;
}

Perturbation::Densities EyePerturbation::walked(const PssState& x, const PssState& y, int end) const {
    Densities densities;
    for (int i = 0; i < end; ++i) {
        // Symmetric in raster space, in which the density of x_1 is a constant times E_1.
        if ((i == 0 && raster_.used) || (i > 0 && specular(x.measure, i)))
            add_followed(x, y, i, 1, densities);
        else
            add_perturbed(x, y, i, 1, kernel(x, i), kernel(y, i), densities);
    }
    return densities;
}

Proposal EyePerturbation::propose(PssState& x, PssState& y, Rng& rng) const {
    const Structure before = structure(x);
    const int end = before.end;
    keep(x, y);
    if (const Failure failure = walk(x, y, end, rng); failure != Failure::none) return Proposal::failed(failure);
    if (const PathFailure failure = charts_.complete(y); failure != PathFailure::none)
        return Proposal::failed(to_failure(failure));
    if (!same_structure(x, y, before)) return Proposal::failed(Failure::outside_support);
    const Vertex* const v = y.path.room.data();
    if (end < y.path.k && !visible(tracer(), v[end], v[end + 1])) return Proposal::failed(Failure::occluded);
    const Densities densities = walked(x, y, end);
    return proposal(x, y, densities.forth, densities.back);
}

}  // namespace keyhole
