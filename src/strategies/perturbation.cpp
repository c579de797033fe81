#include "strategies/perturbation.h"

#include "pathspace/neighbours.h"

namespace keyhole {
namespace {

Failure too_short(int step) { return step > 0 ? Failure::eye_subpath_short : Failure::light_subpath_short; }

// ln of the density of a direction, as one of the vertex that it leads to.
double log_density(const DirectionKernel& kernel, double angle, const Vertex& from, const Vertex& to, const Vec3& d) {
    return kernel.log_pdf(angle) + std::log(to_measure(from, to, d));
}

}  // namespace

Failure Perturbation::arrived(const PssState& y, int i, int step, Extension extension) {
    const bool at_emitter = i + step == y.path.k;
    if (at_emitter && (extension == Extension::surface || extension == Extension::escaped))
        return at(y, i + step).x.emitter ? Failure::none : too_short(step);
    return extension == Extension::surface ? Failure::none : too_short(step);
}

Failure Perturbation::perturb(const PssState& x, PssState& y, int i, int step, const DirectionKernel& kernel,
                              Rng& rng) const {
    const double first = rng.uniform();
    const Vec3 d = kernel.sample(direction(at(x, i), at(x, i + step)), {first, rng.uniform()});
    Vertex& next = y.path.room[static_cast<std::size_t>(i + step)];
    return arrived(y, i, step, trace_from(tracer(), at(y, i), d, next));
}

Failure Perturbation::follow(const PssState& x, PssState& y, int i, int step, Rng& rng) const {
    const Mode mode = step > 0 ? Mode::eye : Mode::light;
    const Vertex& v = at(x, i);
    const Vec3 known = v.x.frame.to_local(direction(v, at(x, i - step)));
    const Vec3 w = v.x.frame.to_local(direction(v, at(x, i + step)));
    const auto numbers = v.x.bsdf->invert(v.x, known, w, {v.delta, v.lobe}, fresh_numbers(rng), mode);
    if (!numbers) return Failure::inverse_failed;
    Vertex* const room = y.path.room.data();
    const Extension e =
        extend(tracer(), mode, room[i - step], room[i], room[i + step], numbers->lobe, numbers->direction);
    if (const Failure failure = arrived(y, i, step, e); failure != Failure::none) return failure;
    const bool same_event = room[i].delta == v.delta && (!v.delta || room[i].lobe == v.lobe);
    return same_event ? Failure::none : Failure::outside_support;
}

void Perturbation::add_perturbed(const PssState& x, const PssState& y, int i, int step, const DirectionKernel& at_x,
                                 const DirectionKernel& at_y, Densities& densities) {
    const Vec3 dx = direction(at(x, i), at(x, i + step)), dy = direction(at(y, i), at(y, i + step));
    const double angle = angle_between(dx, dy);
    densities.forth += log_density(at_x, angle, at(y, i), at(y, i + step), dy);
    densities.back += log_density(at_y, angle, at(x, i), at(x, i + step), dx);
}

void Perturbation::add_followed(const PssState& x, const PssState& y, int i, int step, Densities& densities) {
    const auto next = static_cast<std::size_t>(i + step);
    densities.forth += std::log(step > 0 ? y.measure.eye[next] : y.measure.light[next]);
    densities.back += std::log(step > 0 ? x.measure.eye[next] : x.measure.light[next]);
}

}  // namespace keyhole
