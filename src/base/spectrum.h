// Linear sRGB triples. Radiance, reflectance and path contributions are all of this type.
#pragma once

#include <Eigen/Core>

namespace keyhole {

using Spectrum = Eigen::Array3d;

// CIE Y of linear sRGB primaries (Rec. 709).
inline double luminance(const Spectrum& s) { return 0.212671 * s[0] + 0.715160 * s[1] + 0.072169 * s[2]; }

inline bool is_black(const Spectrum& s) { return !(s[0] > 0 || s[1] > 0 || s[2] > 0); }

}  // namespace keyhole
