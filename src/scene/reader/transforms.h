// <transform> elements.
#pragma once

#include "base/vec.h"
#include "scene/reader/xml.h"

namespace keyhole {

// The operations in file order: each later one is applied after the earlier ones. Throws InputError for bad numbers,
// matrices that are not affine, and a result that is singular.
Affine parse_transform(const Element& transform);

// The same operations on (u, v) in homogeneous form; a matrix of nine numbers is the 2-D map itself. InputError if it
// is singular or mixes in the third coordinate.
Eigen::Matrix3d parse_uv_transform(const Element& transform);

// x, y, z (each 0 if left out) or value="x, y, z", of <point>, <vector> and the operations.
Vec3 parse_xyz(const Element& element, double missing = 0);

}  // namespace keyhole
