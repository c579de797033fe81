#include "render/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/srgb.h"

namespace keyhole {
namespace {

std::string lower_extension(const std::string& filename) {
    std::string extension = std::filesystem::path(filename).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

// Which channels of the file are red, green and blue. Grey images have all three in one.
std::array<int, 3> colour_channels(const OIIO::ImageSpec& spec) {
    const std::array<int, 3> named = {spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
    if (*std::min_element(named.begin(), named.end()) >= 0) return named;
    if (spec.nchannels < 3) return {0, 0, 0};
    return {0, 1, 2};
}

bool is_integer(const OIIO::TypeDesc& format) {
    return !(format == OIIO::TypeHalf || format == OIIO::TypeFloat || format.basetype == OIIO::TypeDesc::DOUBLE);
}

void decode_srgb(std::vector<float>& values) {
    for (float& v : values) v = static_cast<float>(srgb_decode(v));
}

std::vector<unsigned char> encode_8bit(const Image& image, double exposure) {
    const double scale = std::exp2(exposure);
    std::vector<unsigned char> bytes(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(), [scale](float v) {
        // Written so that a value that is not a number becomes 0.
        const double encoded = srgb_encode(scale * v > 0 ? std::min(scale * v, 1.0) : 0.0);
        return static_cast<unsigned char>(std::lround(255 * encoded));
    });
    return bytes;
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& filename) {
    auto input = OIIO::ImageInput::open(filename);
    if (!input) throw InputError({filename}, "cannot read the image: " + OIIO::geterror());
    return input;
}

[[noreturn]] void cannot_write(const std::string& filename, const std::string& why) {
    throw std::runtime_error("cannot write '" + filename + "': " + why);
}

}  // namespace

std::string image_format(const std::string& filename) {
    const std::string extension = lower_extension(filename);
    if (extension == ".exr") return "openexr";
    if (extension == ".png") return "png";
    throw InputError({}, "'" + filename + "' has " +
                             (extension.empty() ? "no extension" : "the unknown extension '" + extension + "'") +
                             "; valid extensions: .exr (32-bit float, linear), .png (8-bit sRGB)");
}

std::string read_metadata(const std::string& filename, const std::string& key) {
    return std::string(open_image(filename)->spec().get_string_attribute(key));
}

Image read_image(const std::string& filename) {
    const auto input = open_image(filename);
    const OIIO::ImageSpec& spec = input->spec();
    const int channels = spec.nchannels;
    std::vector<float> values(static_cast<std::size_t>(spec.width) * spec.height * channels);
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeFloat, values.data()))
        throw InputError({filename}, "cannot read the image: " + input->geterror());

    Image image(spec.width, spec.height);
    const std::array<int, 3> source = colour_channels(spec);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        image.rgb[i] = values[i / 3 * static_cast<std::size_t>(channels) + static_cast<std::size_t>(source[i % 3])];
    if (is_integer(spec.format) && spec.get_string_attribute("oiio:ColorSpace") != "Linear") decode_srgb(image.rgb);
    return image;
}

void write_image(const std::string& filename, const Image& image, const WriteOptions& options) {
    const std::string format = image_format(filename);
    const bool png = format == "png";
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) cannot_write(filename, OIIO::geterror());

    OIIO::ImageSpec spec(image.width, image.height, 3, png ? OIIO::TypeUInt8 : OIIO::TypeFloat);
    if (!png) spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", png ? "sRGB" : "Linear");
    for (const auto& [key, value] : options.metadata) spec.attribute(key, value);

    // Encoded in memory and written in one go: OpenImageIO's PNG writer says nothing when the disk is full.
    OIIO::Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory) || !output->open(filename, spec)) cannot_write(filename, output->geterror());
    const bool encoded = png ? output->write_image(OIIO::TypeUInt8, encode_8bit(image, options.exposure).data())
                             : output->write_image(OIIO::TypeFloat, image.rgb.data());
    if (!output->close() || !encoded) cannot_write(filename, output->geterror());
    const std::vector<unsigned char>& bytes = memory.buffer();
    write_file(filename, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace keyhole
