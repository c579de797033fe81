// Which elements exist, what attributes they have and where they may stand.
#pragma once

#include "scene/reader/xml.h"

namespace keyhole {

enum class TagKind {
    scene,
    directive,  // default, include, alias: only directly in <scene>
    plugin,     // bsdf, shape, ...: chosen by its `type`
    reference,
    value,      // float, rgb, ...: a parameter
    transform,  // a parameter made of operations
    operation   // matrix, translate, ...: only in <transform>
};

// Throws InputError for an unknown element, listing those that `parent` may hold.
TagKind tag_kind(const Element& element, const Element& parent);

// Throws InputError unless the element may stand in `parent` and has all required and no unknown attributes.
void check_element(const Element& element, const Element& parent);

}  // namespace keyhole
