// The transform under which an instanced shape is seen.
#pragma once

#include "base/vec.h"

namespace keyhole {

struct InstanceTransform {
    Affine to_world;            // rounded to float, as Embree keeps it
    Affine to_local;            // its inverse in double precision
    Eigen::Matrix3d normal;     // takes normals to world space, not normalised (the inverse transpose)
    Eigen::Matrix3d magnitude;  // |M^-1| |M| |M^-1|: what float errors in world space grow to in local space

    explicit InstanceTransform(const Affine& transform)
        : to_world(transform.cast<float>().cast<double>()),
          to_local(to_world.inverse()),
          normal(to_local.linear().transpose()),
          magnitude(to_local.linear().cwiseAbs() * to_world.linear().cwiseAbs() * to_local.linear().cwiseAbs()) {}
};

}  // namespace keyhole
