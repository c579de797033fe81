// Linear sRGB triples. Radiance, reflectance and path contributions are all of this type.
#pragma once

#include <Eigen/Core>

namespace keyhole {

using Spectrum = Eigen::Array3d;

// CIE Y of linear sRGB primaries (Rec. 709).
inline double luminance(const Spectrum& s) { return 0.212671 * s[0] + 0.715160 * s[1] + 0.072169 * s[2]; }

// f*, the scalar that a chain's target makes of a contribution.
enum class TargetFunction { luminance, max_channel };

inline double scalar(TargetFunction target, const Spectrum& s) {
    return target == TargetFunction::luminance ? luminance(s) : s.maxCoeff();
}

inline bool is_black(const Spectrum& s) { return !(s[0] > 0 || s[1] > 0 || s[2] > 0); }

}  // namespace keyhole
