// Transforms of things that have a place and an orientation but no size: cameras, environment maps.
#pragma once

#include "base/vec.h"

namespace keyhole {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;

// The linear part of `transform` without its uniform scale: the orthogonal matrix (a rotation, maybe with a reflection)
// nearest to it. Throws std::invalid_argument, naming `what`, if it is singular, not finite, sheared or scaled
// non-uniformly by more than 1 part in 1000 (scene files print matrices with few digits).
Matrix3 orthogonal_part(const Affine& transform, const char* what);

}  // namespace keyhole
