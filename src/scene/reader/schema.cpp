#include "scene/reader/schema.h"

#include <algorithm>

namespace keyhole {
namespace {

struct Tag {
    std::string name;
    TagKind kind;
    std::vector<std::string> required, optional;
};

const std::vector<Tag>& tags() {
    using enum TagKind;
    static const std::vector<Tag> all = {
        {"scene", scene, {"version"}, {}},
        {"default", directive, {"name", "value"}, {}},
        {"include", directive, {"filename"}, {}},
        {"alias", directive, {"id", "as"}, {}},
        {"integrator", plugin, {"type"}, {"id", "name"}},
        {"sensor", plugin, {"type"}, {"id", "name"}},
        {"sampler", plugin, {"type"}, {"id", "name"}},
        {"film", plugin, {"type"}, {"id", "name"}},
        {"rfilter", plugin, {"type"}, {"id", "name"}},
        {"bsdf", plugin, {"type"}, {"id", "name"}},
        {"texture", plugin, {"type"}, {"id", "name"}},
        {"emitter", plugin, {"type"}, {"id", "name"}},
        {"shape", plugin, {"type"}, {"id", "name"}},
        {"ref", reference, {"id"}, {"name"}},
        {"float", value, {"name", "value"}, {}},
        {"integer", value, {"name", "value"}, {}},
        {"boolean", value, {"name", "value"}, {}},
        {"string", value, {"name", "value"}, {}},
        {"point", value, {"name"}, {"x", "y", "z", "value"}},
        {"vector", value, {"name"}, {"x", "y", "z", "value"}},
        {"rgb", value, {"name", "value"}, {"intent"}},
        {"srgb", value, {"name", "value"}, {"intent"}},
        {"spectrum", value, {"name"}, {"value", "filename", "type", "intent"}},
        {"blackbody", value, {"name", "temperature"}, {"scale"}},
        {"transform", transform, {"name"}, {}},
        {"matrix", operation, {"value"}, {}},
        {"translate", operation, {}, {"x", "y", "z", "value"}},
        {"scale", operation, {}, {"x", "y", "z", "value"}},
        {"rotate", operation, {"angle"}, {"x", "y", "z", "value"}},
        {"lookat", operation, {"origin", "target", "up"}, {}},
    };
    return all;
}

bool may_stand(TagKind child, const Element& parent, TagKind parent_kind) {
    using enum TagKind;
    switch (parent_kind) {
        case scene:
            return child == directive || child == plugin;
        case plugin:
            return child == plugin || child == reference || child == value || child == transform;
        case transform:
            return child == operation;
        case value:
            return parent.tag == "spectrum" && parent.attribute("type") && child == value;
        default:
            return false;
    }
}

const Tag* find_tag(const std::string& name) {
    const auto found = std::find_if(tags().begin(), tags().end(), [&](const Tag& tag) { return tag.name == name; });
    return found == tags().end() ? nullptr : &*found;
}

const Tag& allowed_tag(const Element& element, const Element& parent) {
    const TagKind parent_kind = find_tag(parent.tag)->kind;
    const Tag* tag = find_tag(element.tag);
    if (tag && may_stand(tag->kind, parent, parent_kind)) return *tag;
    std::vector<std::string> names;
    for (const Tag& candidate : tags())
        if (may_stand(candidate.kind, parent, parent_kind)) names.push_back(candidate.name);
    throw InputError(element.where, std::string(tag ? "misplaced" : "unknown") + " element <" + element.tag + "> in <" +
                                        parent.tag + ">; " + valid_names(element.tag, names));
}

}  // namespace

TagKind tag_kind(const Element& element, const Element& parent) { return allowed_tag(element, parent).kind; }

void check_element(const Element& element, const Element& parent) {
    const bool root = element.tag == "scene" && &element == &parent;
    const Tag& tag = root ? *find_tag("scene") : allowed_tag(element, parent);
    for (const auto& name : tag.required) element.required_attribute(name);
    std::vector<std::string> names = tag.required;
    names.insert(names.end(), tag.optional.begin(), tag.optional.end());
    for (const Attribute& attribute : element.attributes)
        if (std::find(names.begin(), names.end(), attribute.name) == names.end())
            throw InputError(element.where, "unknown attribute '" + attribute.name + "' of <" + element.tag + ">; " +
                                                valid_names(attribute.name, names));
}

}  // namespace keyhole
