// Shapes that are meshes of a few triangles.
#pragma once

#include "scene/shape.h"

namespace keyhole {

// [-1,1]^2 in z = 0, normal +z, uv in [0,1]^2. With `mirrored`, wound the other way round: under a transform that
// reflects, the normal stays on the side that local +z is taken to.
std::shared_ptr<const Mesh> rectangle_mesh(bool mirrored);
// [-1,1]^3, normals outward, uv in [0,1]^2 on each face.
std::shared_ptr<const Mesh> cube_mesh(bool mirrored);

}  // namespace keyhole
