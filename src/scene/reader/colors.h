// Colour elements: rgb, srgb, spectrum, blackbody and plain numbers.
#pragma once

#include "base/spectrum.h"
#include "scene/reader/properties.h"

namespace keyhole {

// What a colour is decides how wavelengths become RGB and which values are possible.
enum class Quantity {
    reflectance,  // 0 to 1
    emission,     // not negative
    index         // of refraction or absorption: not negative
};

// Whether the element is a colour of any kind (else it may be a texture or a mistake).
bool is_color(const Element& element);

// Linear sRGB. `what` names the parameter. Throws InputError for values outside of what the quantity allows.
Spectrum parse_color(const Element& element, Quantity quantity, const std::string& what, const Document& document);

}  // namespace keyhole
