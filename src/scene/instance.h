// The transform under which an instanced shape is seen.
#pragma once

#include "base/vec.h"

namespace keyhole {

struct InstanceTransform {
    Affine to_world;            // rounded to float, as Embree keeps it
    Affine to_local;            // its inverse in double precision
    Eigen::Matrix3d normal;     // takes normals to world space, not normalised (the inverse transpose)
    Eigen::Matrix3d magnitude;  // |M^-1| |M| |M^-1|: what float errors in world space grow to in local space

    explicit InstanceTransform(const Affine& transform);
};

}  // namespace keyhole
