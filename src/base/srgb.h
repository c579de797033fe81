// The transfer function of sRGB (IEC 61966-2-1), per channel.
#pragma once

#include <cmath>

namespace keyhole {

// Linear [0,1] to encoded [0,1].
inline double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// Encoded [0,1] to linear [0,1].
inline double srgb_decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace keyhole
