#include "scene/reader/colors.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "base/srgb.h"
#include "scene/reader/cie.h"
#include "scene/reader/files.h"
#include "scene/reader/values.h"

namespace keyhole {
namespace {

Spectrum triple(const Element& element, const std::string& what) {
    const auto v = parse_numbers(element.required_attribute("value"), element.where, what);
    if (v.size() == 1) return Spectrum::Constant(v[0]);
    if (v.size() != 3)
        throw InputError(element.where, what + " has " + std::to_string(v.size()) + " numbers; it needs 1 or 3");
    return {v[0], v[1], v[2]};
}

Spectrum decoded_srgb(const Spectrum& encoded) {
    return encoded.unaryExpr([](double v) { return srgb_decode(v); });
}

// "#rrggbb", gamma-encoded as everywhere.
Spectrum hexadecimal(const std::string& text, const SourceLocation& where, const std::string& what) {
    const bool digits = text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (text.size() != 7 || !digits) throw InputError(where, what + ": '" + text + "' is not a colour like #rrggbb");
    const unsigned long bits = std::stoul(text.substr(1), nullptr, 16);
    return decoded_srgb(Spectrum(static_cast<double>(bits >> 16 & 255), static_cast<double>(bits >> 8 & 255),
                                 static_cast<double>(bits & 255)) /
                        255);
}

void add_knot(SampledSpectrum& s, double nm, double value, const SourceLocation& where, const std::string& what) {
    if (!(nm > 0)) throw InputError(where, what + ": wavelength " + number_text(nm) + " is not positive");
    if (!s.wavelengths.empty() && !(nm > s.wavelengths.back()))
        throw InputError(where, what + ": wavelength " + number_text(nm) + " does not increase");
    s.wavelengths.push_back(nm);
    s.values.push_back(value);
}

// "400:0.1, 500:0.2".
SampledSpectrum parse_knots(const std::string& text, const SourceLocation& where, const std::string& what) {
    std::string spaced = text;
    for (char& c : spaced)
        if (c == ',') c = ' ';
    SampledSpectrum s;
    std::istringstream words(spaced);
    for (std::string word; words >> word;) {
        const auto colon = word.find(':');
        if (colon == std::string::npos) throw InputError(where, what + ": '" + word + "' is not wavelength:value");
        add_knot(s, parse_number(word.substr(0, colon), where, what), parse_number(word.substr(colon + 1), where, what),
                 where, what);
    }
    return s;
}

// A .spd file: a wavelength and a value in each line, # starts a comment.
SampledSpectrum read_spd(const std::string& filename, const SourceLocation& from) {
    std::istringstream lines(read_file(filename, from));
    SampledSpectrum s;
    SourceLocation where{filename, 0, 1};
    for (std::string line; std::getline(lines, line);) {
        ++where.line;
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const auto v = parse_numbers(line, where, "spectrum");
        if (v.size() != 2) throw InputError(where, "a line of a spectrum file holds a wavelength and a value");
        add_knot(s, v[0], v[1], where, "spectrum");
    }
    if (s.values.empty()) throw InputError(where, "the spectrum is empty");
    return s;
}

// Saturated spectra lie outside the gamut of sRGB: they are clipped to it.
Spectrum emission_to_rgb(const std::function<double(double)>& spectrum) { return emitted_rgb(spectrum).max(0.0); }

Spectrum to_rgb(const SampledSpectrum& s, Quantity quantity) {
    if (quantity == Quantity::emission)  // light is what is listed, and no more
        return emission_to_rgb(
            [&](double nm) { return nm < s.wavelengths.front() || nm > s.wavelengths.back() ? 0.0 : s(nm); });
    const Spectrum rgb = reflected_rgb(s).max(0.0);
    return quantity == Quantity::reflectance ? rgb.min(1.0).eval() : rgb;
}

Spectrum black_body(double kelvin, double scale, const Element& element, const std::string& what) {
    if (!(kelvin > 0 && kelvin < 1e6))
        throw InputError(element.where, what + ": temperature is " + number_text(kelvin) + " K; it must be positive");
    return scale * emission_to_rgb([=](double nm) { return planck(nm, kelvin); });
}

// <blackbody>, or <spectrum type="blackbody"> with its parameters inside.
Spectrum parse_black_body(const Element& element, const std::string& what) {
    const std::string& kelvin = element.required_attribute("temperature");
    const std::string* scale = element.attribute("scale");
    return black_body(parse_with_unit(kelvin, "K", element.where, what),
                      scale ? parse_number(*scale, element.where, what) : 1.0, element, what);
}

Spectrum parse_spectrum_plugin(const Element& element, const std::string& what, const Document& document) {
    Notes strict;
    Properties p(element, document, strict);
    const std::string& type = *element.attribute("type");
    Spectrum result;
    if (type == "uniform") {
        result = Spectrum::Constant(p.number("value", Range::not_negative(), 1));
    } else if (type == "blackbody") {
        const double kelvin = p.number("temperature", Range::positive());
        result = black_body(kelvin, p.number("scale", Range::not_negative(), 1), element, what);
    } else {
        throw InputError(element.where,
                         "unknown spectrum '" + type + "'; " + valid_names(type, {"blackbody", "uniform"}));
    }
    p.finish();
    return result;
}

void check_values(const SampledSpectrum& s, Quantity quantity, const Element& element, const std::string& what) {
    for (const double v : s.values)
        if (v < 0 || (quantity == Quantity::reflectance && v > 1))
            throw InputError(element.where,
                             what + " has the value " + number_text(v) +
                                 (v < 0 ? "; it must not be negative" : "; above 1 it would not conserve energy"));
}

Spectrum parse_spectrum(const Element& element, Quantity quantity, const std::string& what, const Document& document) {
    const std::string *value = element.attribute("value"), *filename = element.attribute("filename"),
                      *type = element.attribute("type");
    if ((value != nullptr) + (filename != nullptr) + (type != nullptr) != 1)
        throw InputError(element.where, what + ": <spectrum> needs one of value, filename and type");
    if (type) return parse_spectrum_plugin(element, what, document);
    if (value && value->find(':') == std::string::npos)
        return Spectrum::Constant(parse_number(*value, element.where, what));
    const SampledSpectrum s = value ? parse_knots(*value, element.where, what)
                                    : read_spd(find_file(*filename, element.where, document.filename), element.where);
    check_values(s, quantity, element, what);
    return to_rgb(s, quantity);
}

Spectrum parse_unchecked(const Element& element, Quantity quantity, const std::string& what, const Document& document) {
    if (element.tag == "spectrum") return parse_spectrum(element, quantity, what, document);
    if (element.tag == "float" || element.tag == "integer")
        return Spectrum::Constant(parse_number(*element.attribute("value"), element.where, what));
    if (element.tag == "blackbody") {
        if (quantity != Quantity::emission)
            throw InputError(element.where, what + " is a <blackbody>, which only emitters can have");
        return parse_black_body(element, what);
    }
    const std::string& value = element.required_attribute("value");
    if (!value.empty() && value[0] == '#') return hexadecimal(value, element.where, what);
    const Spectrum given = triple(element, what);
    if (element.tag == "rgb") return given;
    if (given.minCoeff() < 0 || given.maxCoeff() > 1)
        throw InputError(element.where, what + ": values of <srgb> lie between 0 and 1");
    return decoded_srgb(given);
}

}  // namespace

bool is_color(const Element& element) {
    for (const char* tag : {"rgb", "srgb", "spectrum", "blackbody", "float", "integer"})
        if (element.tag == tag) return true;
    return false;
}

Spectrum parse_color(const Element& element, Quantity quantity, const std::string& what, const Document& document) {
    const Spectrum color = parse_unchecked(element, quantity, what, document);
    const auto fail = [&](const char* why) {
        throw InputError(element.where, fmt::format("{} is {}, {}, {}; {}", what, number_text(color[0]),
                                                    number_text(color[1]), number_text(color[2]), why));
    };
    if (color.minCoeff() < 0) fail("it must not be negative");
    if (quantity == Quantity::reflectance && color.maxCoeff() > 1) fail("above 1 it would not conserve energy");
    if (!(color.maxCoeff() <= Range::largest)) fail("that is out of range");
    return color;
}

}  // namespace keyhole
