// BSDFs. Parameters and defaults are Mitsuba's; where its versions differ, those of the file's dialect.
#include "scene/reader/materials.h"
#include "scene/reader/plugins.h"
#include "scene/reader/values.h"

namespace keyhole {
namespace {

// Below this a microfacet distribution is a mirror for all purposes but has densities that overflow.
constexpr Range roughness{1e-4, Range::largest};

double ior(Properties& p, const std::string& name, const std::string& fallback) {
    const Properties::Child* child = p.find(name);
    if (child && child->target->tag != "string") return p.number(name, Range::positive());
    const std::string material = child ? *p.find_string(name) : fallback;
    if (const auto value = dielectric_by_name(material)) return *value;
    p.fail(*child, "is '" + material + "'; " + valid_names(material, dielectric_names()));
}

// Interior over exterior.
double relative_ior(Properties& p, const std::string& interior) {
    const double inside = ior(p, "int_ior", interior);
    return inside / ior(p, "ext_ior", "air");
}

// eta and k, or a material, relative to the outside. Mitsuba 0.x defaults to copper, 3.x to a perfect mirror.
ConductorIor conductor_ior(Properties& p, Context& context) {
    const auto name = p.find_string("material");
    const double outside = p.has("ext_eta") ? ior(p, "ext_eta", "air") : 1;
    if (p.has("eta") || p.has("k")) {
        if (name && *name != "none") p.fail(*p.find("material"), "excludes 'eta' and 'k'");
        p.require("eta");
        p.require("k");
        return {context.color(p, "eta", Quantity::index, Spectrum::Zero()) / outside,
                context.color(p, "k", Quantity::index, Spectrum::Zero()) / outside};
    }
    p.find("eta");  // valid names
    p.find("k");
    const std::string material = name.value_or(p.element().old_dialect ? "Cu" : "none");
    auto found = conductor_by_name(material);
    if (!found) p.fail(*p.find("material"), "is '" + material + "'; " + valid_names(material, conductor_names()));
    if (material == "none") return *found;
    return {found->eta / outside, found->k / outside};
}

MicrofacetType distribution(Properties& p) {
    const bool ggx = p.choice("distribution", {"beckmann", "ggx"}, "beckmann") == "ggx";
    if (!p.boolean("sample_visible", true))
        p.fail(*p.find("sample_visible"), "is false; visible normals are always sampled");
    return ggx ? MicrofacetType::ggx : MicrofacetType::beckmann;
}

struct Roughness {
    ScalarInput u, v;
};

Roughness alpha(Properties& p, Context& context) {
    const bool both = p.has("alpha_u") || p.has("alpha_v");
    if (both && p.has("alpha")) p.fail(*p.find("alpha"), "excludes 'alpha_u' and 'alpha_v'");
    const ScalarInput isotropic = context.scalar(p, "alpha", roughness, 0.1);
    if (both) {
        p.require("alpha_u");
        p.require("alpha_v");
    }
    const ScalarInput u = context.scalar(p, "alpha_u", roughness, 0.1),
                      v = context.scalar(p, "alpha_v", roughness, 0.1);
    return both ? Roughness{u, v} : Roughness{isotropic, isotropic};
}

BsdfPtr diffuse(Properties& p, Context& context) {
    if (p.has("diffuse_reflectance") && !p.has("reflectance"))  // a second name in Mitsuba 0.6
        return make_diffuse(context.reflectance(p, "diffuse_reflectance", 0.5));
    return make_diffuse(context.reflectance(p, "reflectance", 0.5));
}

BsdfPtr conductor(Properties& p, Context& context) {
    const ConductorIor eta_k = conductor_ior(p, context);
    return make_conductor(eta_k, context.reflectance(p, "specular_reflectance", 1));
}

BsdfPtr rough_conductor(Properties& p, Context& context) {
    const MicrofacetType type = distribution(p);
    const Roughness a = alpha(p, context);
    const ConductorIor eta_k = conductor_ior(p, context);
    return make_rough_conductor(type, a.u, a.v, eta_k, context.reflectance(p, "specular_reflectance", 1));
}

BsdfPtr dielectric(Properties& p, Context& context) {
    const double eta = relative_ior(p, "bk7");
    const ColorInput reflectance = context.reflectance(p, "specular_reflectance", 1);
    return make_dielectric(eta, reflectance, context.reflectance(p, "specular_transmittance", 1));
}

BsdfPtr thin_dielectric(Properties& p, Context& context) {
    const double eta = relative_ior(p, "bk7");
    const ColorInput reflectance = context.reflectance(p, "specular_reflectance", 1);
    return make_thin_dielectric(eta, reflectance, context.reflectance(p, "specular_transmittance", 1));
}

BsdfPtr rough_dielectric(Properties& p, Context& context) {
    const MicrofacetType type = distribution(p);
    const Roughness a = alpha(p, context);
    const double eta = relative_ior(p, "bk7");
    const ColorInput reflectance = context.reflectance(p, "specular_reflectance", 1);
    return make_rough_dielectric(type, a.u, a.v, eta, reflectance, context.reflectance(p, "specular_transmittance", 1));
}

BsdfPtr plastic(Properties& p, Context& context) {
    const double eta = relative_ior(p, "polypropylene");
    const ColorInput diffuse_part = context.reflectance(p, "diffuse_reflectance", 0.5);
    const ColorInput specular_part = context.reflectance(p, "specular_reflectance", 1);
    return make_plastic(eta, diffuse_part, specular_part, p.boolean("nonlinear", false));
}

BsdfPtr rough_plastic(Properties& p, Context& context) {
    const MicrofacetType type = distribution(p);
    const double a = p.number("alpha", roughness, 0.1);
    const double eta = relative_ior(p, "polypropylene");
    const ColorInput diffuse_part = context.reflectance(p, "diffuse_reflectance", 0.5);
    const ColorInput specular_part = context.reflectance(p, "specular_reflectance", 1);
    return make_rough_plastic(type, a, eta, diffuse_part, specular_part, p.boolean("nonlinear", false));
}

BsdfPtr phong(Properties& p, Context& context) {
    const ScalarInput exponent = context.scalar(p, "exponent", Range::not_negative(), 30);
    const ColorInput diffuse_part = context.reflectance(p, "diffuse_reflectance", 0.5);
    const ColorInput specular_part = context.reflectance(p, "specular_reflectance", 0.2);
    const double sum = diffuse_part.texture || specular_part.texture
                           ? diffuse_part.maximum() + specular_part.maximum()
                           : (diffuse_part.constant + specular_part.constant).maxCoeff();
    if (sum > 1 + 1e-6)
        throw InputError(p.element().where, "diffuse_reflectance and specular_reflectance of " + p.title() +
                                                " add up to " + number_text(sum) +
                                                "; above 1 it would not conserve energy");
    return make_phong(exponent, diffuse_part, specular_part);
}

BsdfPtr mask(Properties& p, Context& context) {
    const ScalarInput opacity = context.scalar(p, "opacity", Range::unit(), 0.5);
    return make_mask(context.bsdf(*p.require_object("bsdf").target), opacity);
}

// One or two BSDFs of surfaces that nothing passes.
BsdfPtr two_sided(Properties& p, Context& context) {
    const auto nested = p.objects("bsdf");
    if (nested.empty() || nested.size() > 2)
        throw InputError(p.element().where,
                         p.title() + " has " + std::to_string(nested.size()) + " nested bsdfs; it needs one or two");
    std::vector<BsdfPtr> sides;
    for (const Properties::Child* child : nested) {
        sides.push_back(context.bsdf(*child->target));
        if (sides.back()->traits().transmissive)
            throw InputError(child->given->where,
                             p.title() + " cannot hold '" + sides.back()->name() + "': light passes through it");
    }
    return make_two_sided(sides.front(), sides.back());
}

BsdfPtr bump_map(Properties& p, Context& context) {
    const double scale = p.number("scale", Range::any(), 1);
    auto displacement = context.texture(*p.require_object("texture").target);
    return make_bump_map(context.bsdf(*p.require_object("bsdf").target), std::move(displacement), scale);
}

BsdfPtr null(Properties&, Context&) { return make_null(); }

BsdfPtr blend(Properties& p, Context& context) {
    p.require("weight");
    const ScalarInput weight = context.scalar(p, "weight", Range::unit(), 0.5);
    const auto nested = p.objects("bsdf");
    if (nested.size() != 2)
        throw InputError(p.element().where,
                         p.title() + " has " + std::to_string(nested.size()) + " nested bsdfs; it needs two");
    BsdfPtr first = context.bsdf(*nested[0]->target);
    return make_blend(std::move(first), context.bsdf(*nested[1]->target), weight);
}

}  // namespace

const Plugins<BsdfMaker>& bsdf_plugins() {
    static const Plugins<BsdfMaker> all = {
        {"diffuse", diffuse},
        {"conductor", conductor},
        {"roughconductor", rough_conductor},
        {"dielectric", dielectric},
        {"thindielectric", thin_dielectric},
        {"roughdielectric", rough_dielectric},
        {"plastic", plastic},
        {"roughplastic", rough_plastic},
        {"phong", phong},
        {"mask", mask},
        {"twosided", two_sided},
        {"bumpmap", bump_map},
        {"null", null},
        {"blendbsdf", blend},
    };
    return all;
}

}  // namespace keyhole
