#include "compare/false_colour.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/srgb.h"

namespace keyhole {

Image false_colour(std::span<const double> errors, int width, double maximum) {
    const int height = static_cast<int>(errors.size()) / width;
    std::vector<float> scaled(errors.size());
    std::transform(errors.begin(), errors.end(), scaled.begin(),
                   [maximum](double e) { return static_cast<float>(e > 0 ? std::min(e / maximum, 1.0) : 0.0); });
    Image image(width, height);
    const OIIO::ImageBuf source(OIIO::ImageSpec(width, height, 1, OIIO::TypeFloat), scaled.data());
    // OpenImageIO holds the map as linear values.
    OIIO::ImageBuf mapped(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat), image.rgb.data());
    if (!OIIO::ImageBufAlgo::color_map(mapped, source, 0, "magma")) throw std::runtime_error(mapped.geterror());
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (std::isnan(errors[i / 3])) image.rgb[i] = static_cast<float>(srgb_decode(0.5));
    return image;
}

double error_quantile(std::span<const double> errors, double fraction) {
    std::vector<double> numbers;
    std::copy_if(errors.begin(), errors.end(), std::back_inserter(numbers), [](double e) { return !std::isnan(e); });
    if (numbers.empty()) return 0;
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), numbers.begin() + rank, numbers.end());
    return numbers[static_cast<std::size_t>(rank)];
}

}  // namespace keyhole
