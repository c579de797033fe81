// The page of a comparison: one HTML file that holds the results, the images and everything that shows them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "render/image.h"

namespace keyhole {

struct ReportImage {
    std::string name;  // of the entry, or "reference"
    Image image;
};

// Writes the page in one step. `results`: the content of results.json (docs/results.schema.json). All images must have
// one size. Text that is not UTF-8 is mended. Throws InputError for images of different or no size and
// std::runtime_error if the file cannot be written.
void write_report(const std::string& filename, const nlohmann::json& results, std::span<const ReportImage> images);

// The pixels as 16-bit floats in a compressed form that the page reads. A stored number times `scale` is the value:
// a power of two, 1 unless a finite value is beyond the greatest half, 65504.
struct EncodedImage {
    double scale = 1;
    std::string base64;  // of a zlib stream; see encode_image in report.cpp for its layout
};
EncodedImage encode_image(const Image& image);

}  // namespace keyhole
