#include "strategies/path_space_strategies.h"

#include <fmt/format.h>

#include "strategies/bidirectional.h"
#include "strategies/caustic.h"
#include "strategies/cone_step_size.h"
#include "strategies/eye_perturbation.h"
#include "strategies/portal.h"

namespace keyhole {
namespace {

StrategyInfo path_space(const char* name, const char* description) {
    StrategyInfo info;
    info.name = name;
    info.description = description;
    info.needs = {.path = true, .forgets = true, .measure = true};
    info.hindrance = [](const Scene&, const PathLengths&) { return std::string(); };
    return info;
}

// For chains of at least one specular vertex between two rough ones or ends.
std::string needs_three_edges(const Scene&, const PathLengths& lengths) {
    return lengths.max >= 3 ? "" : "it moves paths of three edges or more";
}

StrategyInfo bidirectional() {
    StrategyInfo info =
        path_space("bidirectional", "Deletes a part of the path and grows another from both ends, of another length");
    info.ergodic = true;
    info.make = [](const StrategyContext& c, const Values&) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<Bidirectional>(*c.charts, c.lengths);
    };
    return info;
}

Parameter roughness() {
    return Parameter::number("roughness", 0.1, 0, 1,
                             "vertices that scatter in a lobe as narrow as this roughness gives count as specular")
        .open();
}

Parameter primary_ray() { return Parameter::choice("primary", {"raster", "angle"}, "how the primary ray moves"); }

// Sizes of steps by angle.
std::vector<Parameter> angles() {
    return {Parameter::number("r-min", 0x1p-8, 0, 1.5, "smallest change of a direction").open().of_step().in("radians"),
            Parameter::number("r-max", 0x1p-4, 0, 1.5, "largest change; logarithms are uniform")
                .open()
                .of_step()
                .in("radians")};
}
std::string contradiction_of_angles(const Values& v) {
    if (number(v, "r-min") < number(v, "r-max")) return {};
    return fmt::format("r-min = {} is not below r-max = {}", number(v, "r-min"), number(v, "r-max"));
}

// These, and pixels where `choice` is "raster".
void add_sizes(StrategyInfo& info, Parameter choice) {
    const std::string name = choice.name;
    const Parameter pixels_min =
        Parameter::number("pixels-min", 0.1, 0, 1e4, "smallest step in the image").open().of_step().in("pixels");
    const Parameter pixels_max =
        Parameter::number("pixels-max", 0, 0, 1e6, "largest step; 0: the radius of a twentieth of the film")
            .of_step()
            .in("pixels");
    info.parameters = angles();
    info.parameters.insert(info.parameters.begin(), std::move(choice));
    for (const Parameter& p : {pixels_min.only_with(name, "raster"), pixels_max.only_with(name, "raster"), roughness()})
        info.parameters.push_back(p);
    info.contradiction = [](const Values& v) -> std::string {
        if (const double most = number(v, "pixels-max"); most > 0 && number(v, "pixels-min") >= most)
            return fmt::format("pixels-min = {} is not below pixels-max = {}", number(v, "pixels-min"), most);
        return contradiction_of_angles(v);
    };
}
std::unique_ptr<const StepSize> fixed_size(const Scene&, const Values& v) {
    return std::make_unique<FixedStepSize>(number(v, "r-min"), number(v, "r-max"));
}
// Of strategies without that choice: none.
RasterStep raster_step(const Values& v, const char* choice) {
    if (!v.contains(choice)) return {};
    return {is_choice(v, choice, "raster"), number(v, "pixels-min"), number(v, "pixels-max")};
}

// Geometry-aware versions: sizes from cones.
void add_cones(StrategyInfo& info) {
    info.parameters = {
        Parameter::choice("estimator", {"bvh-cut", "fast", "exact"}, "how the empty cone about an edge is found"),
        Parameter::integer("boxes", 10, 0, 10000, "boxes beside the edge from which on none is opened any more")
            .only_with("estimator", "bvh-cut"),
        Parameter::number("alpha", 0.1, 0, 0.99, "smallest step over the largest, which is the cone's half-angle")
            .open()
            .of_step(),
        Parameter::number("t1", 1e-4, 0, 0.5, "where the cone begins, in lengths of the edge").open(),
        Parameter::number("t2", 0.99, 0.5, 1, "where it ends"),
        Parameter::number("tau-min", 0.01, 0, 1.5, "smallest half-angle").open().in("radians"),
        Parameter::number("tau-max", 0.5, 0, 1.5, "largest half-angle").open().in("radians"),
        roughness()};
    info.contradiction = [](const Values& v) -> std::string {
        if (number(v, "tau-min") <= number(v, "tau-max")) return {};
        return fmt::format("tau-min = {} is above tau-max = {}", number(v, "tau-min"), number(v, "tau-max"));
    };
}
std::unique_ptr<const StepSize> cone_size(const Scene& scene, const Values& v) {
    ConeSettings settings;
    settings.estimator = is_choice(v, "estimator", "fast")    ? ConeEstimator::fast
                         : is_choice(v, "estimator", "exact") ? ConeEstimator::exact
                                                              : ConeEstimator::bvh_cut;
    settings.boxes = static_cast<int>(std::get<std::int64_t>(v.at("boxes")));
    settings.t1 = number(v, "t1");
    settings.t2 = number(v, "t2");
    settings.tau_min = number(v, "tau-min");
    settings.tau_max = number(v, "tau-max");
    return std::make_unique<ConeStepSize>(scene, settings, number(v, "alpha"));
}

// What makes a strategy's sizes; add_sizes or add_cones have their parameters.
using MakeSize = std::unique_ptr<const StepSize>(const Scene&, const Values&);

template <EyePerturbation::Chains chains, MakeSize make_size>
StrategyInfo eye_perturbation(const char* name, const char* description) {
    StrategyInfo info = path_space(name, description);
    if (chains == EyePerturbation::Chains::many) info.hindrance = needs_three_edges;
    info.make = [](const StrategyContext& c, const Values& v) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<EyePerturbation>(*c.charts, chains, make_size(c.charts->tracer().scene(), v),
                                                 number(v, "roughness"), raster_step(v, "primary"));
    };
    return info;
}

template <MakeSize make_size>
StrategyInfo caustic_perturbation(const char* name, const char* description) {
    StrategyInfo info = path_space(name, description);
    info.hindrance = needs_three_edges;
    info.make = [](const StrategyContext& c, const Values& v) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<CausticPerturbation>(*c.charts, make_size(c.charts->tracer().scene(), v),
                                                     raster_step(v, "size"), number(v, "roughness"));
    };
    return info;
}

StrategyInfo with_sizes(StrategyInfo info, const Parameter& choice) {
    add_sizes(info, choice);
    return info;
}
StrategyInfo with_cones(StrategyInfo info) {
    add_cones(info);
    info.cones = cone_size;
    return info;
}

std::string needs_portals(const Scene& scene, const PathLengths& lengths) {
    if (scene.portals().empty()) return "the scene has no portals";
    return lengths.max >= 2 ? "" : "it moves paths of two edges or more";
}

void add_portal_point(StrategyInfo& info) {
    info.parameters.push_back(
        Parameter::choice("point", {"fixed", "gaussian", "uniform"}, "how the edge's point on the portal moves"));
    info.parameters.push_back(Parameter::number("sigma", 0.1, 0, 10, "standard deviation of its steps")
                                  .open()
                                  .of_step()
                                  .in("times the square root of the portal's area")
                                  .only_with("point", "gaussian"));
}
PortalPoint portal_point(const Values& v) {
    using Move = PortalPoint::Move;
    return {is_choice(v, "point", "fixed")      ? Move::fixed
            : is_choice(v, "point", "gaussian") ? Move::gaussian
                                                : Move::uniform,
            number(v, "sigma")};
}

StrategyInfo portal() {
    StrategyInfo info =
        path_space("portal", "Turns an edge that passes a portal about its point there; both of its ends go along");
    info.parameters = angles();
    info.parameters.insert(
        info.parameters.begin(),
        Parameter::choice("edge", {"nearest", "any"}, "which of the edges that pass a portal, from the sensor"));
    add_portal_point(info);
    info.contradiction = contradiction_of_angles;
    info.hindrance = needs_portals;
    info.make = [](const StrategyContext& c, const Values& v) -> std::unique_ptr<PssStrategy> {
        using Edges = PortalCrossings::Edges;
        return std::make_unique<PortalPerturbation>(
            *c.charts, is_choice(v, "edge", "any") ? Edges::any : Edges::nearest, portal_point(v),
            DirectionKernel{number(v, "r-min"), number(v, "r-max")});
    };
    return info;
}

StrategyInfo portal_lens() {
    StrategyInfo info = path_space("portal-lens",
                                   "As lens, for paths that pass a portal right after: the edge turns about its point "
                                   "there, and its far end goes along");
    add_sizes(info, primary_ray());
    add_portal_point(info);
    info.hindrance = needs_portals;
    info.make = [](const StrategyContext& c, const Values& v) -> std::unique_ptr<PssStrategy> {
        return std::make_unique<PortalLens>(*c.charts, fixed_size(c.charts->tracer().scene(), v),
                                            number(v, "roughness"), raster_step(v, "primary"), portal_point(v));
    };
    return info;
}

}  // namespace

std::vector<StrategyInfo> path_space_strategies() {
    constexpr auto one = EyePerturbation::Chains::one, many = EyePerturbation::Chains::many;
    const Parameter size = Parameter::choice("size", {"raster", "angle"}, "what the size of steps is given by");
    return {
        bidirectional(),
        with_sizes(eye_perturbation<one, fixed_size>(
                       "lens", "Perturbs the primary ray, follows specular vertices, and connects the first rough one"),
                   primary_ray()),
        with_sizes(
            eye_perturbation<many, fixed_size>(
                "multichain", "As lens, for paths that leave a rough vertex into another chain of specular ones"),
            primary_ray()),
        with_sizes(caustic_perturbation<fixed_size>(
                       "caustic",
                       "Perturbs the direction of light into a chain of specular vertices that ends where the "
                       "sensor looks, and follows the chain"),
                   size),
        with_cones(eye_perturbation<one, cone_size>(
            "lens-geo", "As lens, with steps as large as the empty cone about the primary edge")),
        with_cones(eye_perturbation<many, cone_size>(
            "multichain-geo", "As multichain, with steps as large as the empty cones about the edges")),
        with_cones(caustic_perturbation<cone_size>("caustic-geo",
                                                   "As caustic, with steps as large as the empty cone about the edge")),
        portal(),
        portal_lens()};
}

}  // namespace keyhole
