// The shading frame of a surface point, and the derivatives that bump maps and anisotropic BSDFs read.
#pragma once

#include "scene/surface.h"

namespace keyhole {

// Sets frame and, where the BSDF needs tangents, du_s, dv_s and dv_t. `n` is the unit shading normal; dp/du and dp/dv
// need not be perpendicular to it. Where they are degenerate any frame about `n` is as good as another.
inline void set_shading_frame(SurfacePoint& x, const Vec3& n, bool tangents, const Vec3& dpdu, const Vec3& dpdv) {
    if (tangents) {
        const Vec3 projected = dpdu - n * n.dot(dpdu);
        const double length = projected.norm();
        if (length > 1e-12 * dpdu.norm()) {
            const Vec3 s = projected / length;
            x.frame = {s, n.cross(s), n};
            x.du_s = static_cast<float>(length);
            x.dv_s = static_cast<float>(dpdv.dot(x.frame.s));
            x.dv_t = static_cast<float>(dpdv.dot(x.frame.t));
            return;
        }
    }
    x.frame = Frame::from_normal(n);
    x.du_s = 1;
    x.dv_s = 0;
    x.dv_t = 1;
}

}  // namespace keyhole
