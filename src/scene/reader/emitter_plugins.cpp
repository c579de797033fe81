// Emitters that stand in the scene by themselves.
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

// Given directly, or as the image of `local` under to_world.
Vec3 placed(Properties& p, const std::string& name, const std::string& tag, const Affine& to_world, const Vec3& local) {
    const auto given = p.find_vector(name, tag);
    if (given && p.has("to_world")) p.fail(*p.find(name), "excludes 'to_world'");
    if (given) return *given;
    return tag == "point" ? to_world * local : to_world.linear() * local;
}

std::unique_ptr<Emitter> point(Properties& p, Context& context) {
    const Affine to_world = p.transform("to_world");
    const Vec3 position = placed(p, "position", "point", to_world, Vec3(0, 0, 0));
    return make_point_emitter(position, context.color(p, "intensity", Quantity::emission, Spectrum::Ones()));
}

std::unique_ptr<Emitter> spot(Properties& p, Context& context) {
    const Affine to_world = p.transform("to_world");
    const Spectrum intensity = context.color(p, "intensity", Quantity::emission, Spectrum::Ones());
    const double cutoff = p.number("cutoff_angle", {0, 180, true}, 20);
    const double width = p.number("beam_width", {0, 180}, cutoff * 0.75);
    if (width > cutoff) p.fail(*p.find("beam_width"), "is larger than cutoff_angle");
    return make_spot_emitter(to_world, intensity, cutoff, width);
}

std::unique_ptr<Emitter> directional(Properties& p, Context& context) {
    const Affine to_world = p.transform("to_world");
    const Vec3 direction = placed(p, "direction", "vector", to_world, Vec3(0, 0, 1));
    if (!(direction.norm() > 0)) p.fail(*p.find("direction"), "is zero");
    const Spectrum irradiance = context.color(p, "irradiance", Quantity::emission, Spectrum::Ones());
    return make_directional_emitter(direction.normalized(), irradiance);
}

std::unique_ptr<Emitter> constant(Properties& p, Context& context) {
    return make_constant_emitter(context.color(p, "radiance", Quantity::emission, Spectrum::Ones()));
}

std::unique_ptr<Emitter> envmap(Properties& p, Context& context) {
    EnvmapParams params;
    params.filename = context.file(p, "filename");
    params.scale = p.number("scale", Range::not_negative(), 1);
    params.to_world = p.transform("to_world");
    p.ignore({"cache"});
    try {
        return make_envmap_emitter(params);
    } catch (const InputError& e) {
        throw InputError(p.element().where, e.what());
    }
}

std::unique_ptr<Emitter> area(Properties& p, Context&) {
    throw InputError(p.element().where, "emitter 'area' must stand inside the shape that emits");
}

}  // namespace

const Plugins<EmitterMaker>& emitter_plugins() {
    static const Plugins<EmitterMaker> all = {
        {"area", area},         {"point", point},   {"spot", spot}, {"directional", directional},
        {"constant", constant}, {"envmap", envmap},
    };
    return all;
}

void add_emitter(const Element& element, Context& context) {
    Properties p(element, context.document, context.notes);
    try {
        auto emitter = find_plugin(emitter_plugins(), element)(p, context);
        p.ignore({"sampling_weight"});
        p.finish();
        context.builder.add_emitter(std::move(emitter));
    } catch (const std::invalid_argument& e) {
        throw InputError(element.where, p.title() + ": " + e.what());
    }
}

}  // namespace keyhole
