// Image files as textures and environment maps read them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

// Texels in rows from the top, `channels` (1 or 3) values each; alpha is dropped. Exactly one of the two vectors is
// filled: 8-bit files stay 8-bit, everything else becomes float.
struct ImageFile {
    int width = 0, height = 0, channels = 0;
    bool integer = false;  // the file's values were integers of 8 or more bits, scaled here to [0, 1]
    std::vector<std::uint8_t> bytes;
    std::vector<float> floats;
};

// Reads any file OpenImageIO reads, without changing its values. Throws InputError (without a location) if the file
// cannot be read, is not a flat image of 1 to 4 channels, or has values that are negative or not finite. Thread-safe.
ImageFile read_image_file(const std::string& filename);

// Three linear values a texel: files of integers are decoded from sRGB.
std::vector<float> linear_rgb(const ImageFile& image);

}  // namespace keyhole
