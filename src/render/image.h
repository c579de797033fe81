// Images in memory (linear RGB, float) and in files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/spectrum.h"

namespace keyhole {

struct Image {
    int width = 0, height = 0;
    std::vector<float> rgb;  // row by row from the top, 3 per pixel

    Image() = default;
    Image(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * h * 3, 0.0f) {}
    float* pixel(int x, int y) { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
    const float* pixel(int x, int y) const { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
};

// Any file OpenImageIO reads. Channels named R, G, B, else the first three; an image of one or two channels is grey.
// Integer values are decoded from sRGB unless the file says that they are linear. Throws InputError if it cannot be
// read.
Image read_image(const std::string& filename);

// A text of the image's metadata, such as write_image stores; empty if it has none of that name. Throws InputError if
// the image cannot be read.
std::string read_metadata(const std::string& filename, const std::string& key);

// OpenImageIO's name of the format that write_image uses for the file. Throws InputError, which lists the valid
// extensions, for any other.
std::string image_format(const std::string& filename);

struct WriteOptions {
    std::map<std::string, std::string> metadata;  // EXR attributes / PNG text
    double exposure = 0;                          // stops, PNG only
};
// By extension: .exr (float32, linear) or .png (8-bit sRGB, clipped). Written to a temporary name in the same folder
// and renamed, so a reader never sees half a file. Throws InputError for an unknown extension and std::runtime_error if
// the file cannot be written; an earlier file of that name then stays as it was.
void write_image(const std::string& filename, const Image& image, const WriteOptions& options = {});

}  // namespace keyhole
