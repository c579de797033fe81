#include "compare/report.h"

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/srgb.h"
#include "compare/false_colour.h"
#include "compare/report_template.h"

namespace keyhole {
namespace {

constexpr float greatest_half = 65504;

// The smallest power of two, at least 1, by which the finite values must be divided to be halves.
double half_scale(const Image& image) {
    float greatest = 0;
    for (const float v : image.rgb)
        if (std::isfinite(v)) greatest = std::max(greatest, std::abs(v));
    return greatest <= greatest_half ? 1 : std::exp2(std::ceil(std::log2(double{greatest} / greatest_half)));
}

std::vector<std::uint16_t> to_halves(const Image& image, double scale) {
    std::vector<float> scaled(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), scaled.begin(),
                   [scale](float v) { return static_cast<float>(v / scale); });
    std::vector<std::uint16_t> halves(scaled.size());
    OIIO::convert_pixel_values(OIIO::TypeFloat, scaled.data(), OIIO::TypeHalf, halves.data(),
                               static_cast<int>(scaled.size()));
    return halves;
}

std::string deflate(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string compressed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(compressed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib cannot compress an image");
    compressed.resize(size);
    return compressed;
}

// The colours of errors from 0 to the maximum, as 8-bit sRGB.
nlohmann::json colour_map() {
    std::vector<double> errors(256);
    std::iota(errors.begin(), errors.end(), 0);
    const Image ramp = false_colour(errors, 256, 255);
    nlohmann::json map = nlohmann::json::array();
    for (int x = 0; x < ramp.width; ++x) {
        std::array<int, 3> colour{};
        std::transform(ramp.pixel(x, 0), ramp.pixel(x, 0) + 3, colour.begin(),
                       [](float v) { return static_cast<int>(std::lround(255 * srgb_encode(v))); });
        map.push_back(colour);
    }
    return map;
}

// As the text of a <script>, which nothing but a '<' can end.
std::string script_text(const nlohmann::json& json) {
    std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
    return text;
}

void require_one_size(std::span<const ReportImage> images) {
    for (const ReportImage& i : images)
        if (i.image.width <= 0 || i.image.height <= 0 || i.image.width != images[0].image.width ||
            i.image.height != images[0].image.height)
            throw InputError({}, "image '" + i.name + "' of the report is " + std::to_string(i.image.width) + "x" +
                                     std::to_string(i.image.height) + " pixels; all must have one size above 0");
}

}  // namespace

// The bytes, 6 per pixel: the channels one after another, rows from the top, each half as its difference (mod 2^16)
// from the one before; first the high bytes of all, then the low ones. Neighbours are alike, so the high bytes pack
// well.
EncodedImage encode_image(const Image& image) {
    EncodedImage encoded{half_scale(image), {}};
    const std::vector<std::uint16_t> halves = to_halves(image, encoded.scale);
    const std::size_t count = halves.size(), pixels = count / 3;
    std::string bytes(2 * count, '\0');
    std::uint16_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint16_t half = halves[i % pixels * 3 + i / pixels];
        const auto difference = static_cast<std::uint16_t>(half - before);
        bytes[i] = static_cast<char>(difference >> 8);
        bytes[count + i] = static_cast<char>(difference & 0xff);
        before = half;
    }
    encoded.base64 = OIIO::Strutil::base64_encode(deflate(bytes));
    return encoded;
}

void write_report(const std::string& filename, const nlohmann::json& results, std::span<const ReportImage> images) {
    require_one_size(images);
    std::vector<EncodedImage> encoded(images.size());
    parallel_for(images.size(), [&](std::size_t i) { encoded[i] = encode_image(images[i].image); });

    nlohmann::json infos = nlohmann::json::array();
    for (std::size_t i = 0; i < images.size(); ++i)
        infos.push_back({{"name", images[i].name},
                         {"width", images[i].image.width},
                         {"height", images[i].image.height},
                         {"scale", encoded[i].scale}});
    const nlohmann::json data = {{"results", results}, {"images", infos}, {"colour_map", colour_map()}};

    const std::size_t mark = report_template.find(report_data_mark);
    if (mark == std::string_view::npos) throw std::logic_error("the report's template has no place for its data");
    std::string page(report_template.substr(0, mark));
    page += "<script type=\"application/json\" id=\"data\">" + script_text(data) + "</script>\n";
    for (std::size_t i = 0; i < encoded.size(); ++i)
        page += "<script type=\"application/octet-stream\" id=\"image-" + std::to_string(i) + "\">" +
                encoded[i].base64 + "</script>\n";
    page += report_template.substr(mark + report_data_mark.size());
    write_file(filename, page);
}

}  // namespace keyhole
