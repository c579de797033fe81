#include "scene/textures/image_file.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "base/error.h"
#include "base/srgb.h"

namespace keyhole {
namespace {

[[noreturn]] void fail(const std::string& filename, const std::string& why) {
    throw InputError({}, "cannot use image '" + filename + "': " + why);
}

// Three colour channels if there are as many, else one; a file of more than four must say which they are.
int colour_channels(const std::string& filename, const OIIO::ImageSpec& spec) {
    const bool rgb_first = spec.nchannels >= 3 && spec.channel_name(0) == "R" && spec.channel_name(1) == "G" &&
                           spec.channel_name(2) == "B";
    if (spec.nchannels < 1 || (spec.nchannels > 4 && !rgb_first))
        fail(filename, "it has " + std::to_string(spec.nchannels) + " channels; valid: 1 to 4, or R, G, B and others");
    return spec.nchannels >= 3 ? 3 : 1;
}

template <class T>
void read_texels(OIIO::ImageInput& input, const std::string& filename, OIIO::TypeDesc type, const ImageFile& image,
                 std::vector<T>& texels) {
    texels.resize(static_cast<std::size_t>(image.width) * image.height * image.channels);
    if (!input.read_image(0, 0, 0, image.channels, type, texels.data())) fail(filename, input.geterror());
}

void check_values(const std::string& filename, const ImageFile& image) {
    const auto bad = std::find_if(image.floats.begin(), image.floats.end(),
                                  [](float value) { return !(value >= 0) || !std::isfinite(value); });
    if (bad == image.floats.end()) return;
    const auto texel = (bad - image.floats.begin()) / image.channels;
    fail(filename, "the value at column " + std::to_string(texel % image.width) + ", row " +
                       std::to_string(texel / image.width) + " is " + std::to_string(*bad) +
                       "; valid: finite and not negative");
}

ImageFile read_open_file(OIIO::ImageInput& input, const std::string& filename) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.deep || spec.depth > 1) fail(filename, "it is not a flat image");
    if (spec.width < 1 || spec.height < 1) fail(filename, "it has no texels");
    ImageFile image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = colour_channels(filename, spec);
    image.integer = !spec.format.is_floating_point();
    if (spec.format == OIIO::TypeDesc::UINT8)
        read_texels(input, filename, OIIO::TypeDesc::UINT8, image, image.bytes);
    else
        read_texels(input, filename, OIIO::TypeDesc::FLOAT, image, image.floats);
    check_values(filename, image);
    return image;
}

}  // namespace

ImageFile read_image_file(const std::string& filename) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // else colours come multiplied by their alpha
    const auto input = OIIO::ImageInput::open(filename, &config);
    if (!input) fail(filename, OIIO::geterror());
    try {
        return read_open_file(*input, filename);
    } catch (const std::bad_alloc&) {
        fail(filename, "it does not fit into memory");
    }
}

std::vector<float> linear_rgb(const ImageFile& image) {
    const std::size_t texels = static_cast<std::size_t>(image.width) * image.height;
    const auto value = [&](std::size_t i) {
        const double stored = image.bytes.empty() ? image.floats[i] : image.bytes[i] / 255.0;
        return static_cast<float>(image.integer ? srgb_decode(stored) : stored);
    };
    std::vector<float> rgb(3 * texels);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = value(image.channels == 3 ? i : i / 3);
    return rgb;
}

}  // namespace keyhole
