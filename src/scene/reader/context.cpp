#include "scene/reader/context.h"

#include <algorithm>

#include "scene/reader/files.h"
#include "scene/reader/plugins.h"
#include "scene/reader/values.h"

namespace keyhole {
namespace {

constexpr std::size_t max_nesting = 64;

std::string label(const Element& element) {
    const std::string* id = element.attribute("id");
    return "'" + (id ? *id : element.required_attribute("type")) + "'";
}

}  // namespace

BsdfPtr Context::bsdf(const Element& element) {
    if (const auto made = bsdfs_.find(&element); made != bsdfs_.end()) return made->second;
    if (const auto again = std::find(open_.begin(), open_.end(), &element); again != open_.end()) {
        std::string chain;
        for (auto i = again; i != open_.end(); ++i) chain += label(**i) + " -> ";
        throw InputError(element.where, "bsdf " + label(element) + " refers to itself: " + chain + label(element));
    }
    if (open_.size() == max_nesting)
        throw InputError(element.where, "bsdfs are nested deeper than " + std::to_string(max_nesting));
    open_.push_back(&element);
    Properties p(element, document, notes);
    BsdfPtr made = find_plugin(bsdf_plugins(), element)(p, *this);
    p.finish();
    open_.pop_back();
    return bsdfs_[&element] = made;
}

std::shared_ptr<const Texture> Context::texture(const Element& element) {
    if (const auto made = textures_.find(&element); made != textures_.end()) return made->second;
    Properties p(element, document, notes);
    auto made = find_plugin(texture_plugins(), element)(p, *this);
    p.finish();
    return textures_[&element] = std::move(made);
}

void Context::report_textures() {
    std::set<const Texture*> distinct;
    std::size_t bytes = 0;
    for (const auto& [element, texture] : textures_)
        if (distinct.insert(texture.get()).second) bytes += texture->bytes();
    builder.set_texture_statistics(distinct.size(), bytes);
}

std::string Context::file(Properties& p, const std::string& name) const {
    const std::string given = p.string(name);
    return find_file(given, p.find(name)->given->where, document.filename);
}

ColorInput Context::color_input(Properties& p, const std::string& name, Quantity quantity, double fallback) {
    const Properties::Child* child = p.find(name);
    if (!child) return Spectrum(Spectrum::Constant(fallback));
    if (is_color(*child->target)) return parse_color(*child->target, quantity, p.of(name), document);
    if (child->target->tag != "texture")
        p.fail(*child, "is a <" + child->target->tag +
                           ">; it must be a colour (<rgb>, <srgb>, <spectrum>, <float>) or <texture>");
    auto made = texture(*child->target);
    // Half a step of an 8-bit image above one is rounding, not a value.
    if (quantity == Quantity::reflectance && made->maximum() > 1 + 1e-3)
        p.fail(*child, "has the value " + number_text(made->maximum()) + "; above 1 it would not conserve energy");
    return made;
}

ColorInput Context::reflectance(Properties& p, const std::string& name, double fallback) {
    return color_input(p, name, Quantity::reflectance, fallback);
}

ColorInput Context::radiance(Properties& p, const std::string& name, double fallback) {
    return color_input(p, name, Quantity::emission, fallback);
}

ScalarInput Context::scalar(Properties& p, const std::string& name, Range range, double fallback) {
    const Properties::Child* child = p.find(name);
    if (!child) return fallback;
    if (child->target->tag == "texture") {
        auto made = texture(*child->target);
        if (made->maximum() > range.high)
            p.fail(*child, "has the value " + number_text(made->maximum()) + "; at most " + number_text(range.high));
        return made;
    }
    const std::string& tag = child->target->tag;
    if (tag != "rgb" && tag != "srgb" && tag != "spectrum") return p.number(name, range);
    const Spectrum c = parse_color(*child->target, Quantity::index, p.of(name), document);
    if (c[0] != c[1] || c[1] != c[2]) p.fail(*child, "is a colour; only grey can stand for a number here");
    if (c[0] < range.low || c[0] > range.high)
        p.fail(*child, "is " + number_text(c[0]) + "; it must be between " + number_text(range.low) + " and " +
                           number_text(range.high));
    return c[0];
}

Spectrum Context::color(Properties& p, const std::string& name, Quantity quantity, const Spectrum& fallback) {
    const Properties::Child* child = p.find(name);
    if (!child) return fallback;
    if (!is_color(*child->target))
        p.fail(*child, "is a <" + child->target->tag + ">; it must be a colour: <rgb>, <srgb>, <spectrum> or <float>");
    return parse_color(*child->target, quantity, p.of(name), document);
}

}  // namespace keyhole
