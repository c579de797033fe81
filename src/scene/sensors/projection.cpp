#include "scene/sensors/projection.h"

#include <cmath>
#include <stdexcept>

namespace keyhole {
namespace {

void require(bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(message);
}

// The film's extent along the axis of the field of view, in pixels.
double fov_extent(const PerspectiveParams& p) {
    switch (p.fov_axis) {
        case FovAxis::x:
            return p.width;
        case FovAxis::y:
            return p.height;
        case FovAxis::diagonal:
            return std::hypot(p.width, p.height);
        case FovAxis::smaller:
            return std::min(p.width, p.height);
        case FovAxis::larger:
            return std::max(p.width, p.height);
    }
    return p.width;
}

}  // namespace

Projection::Projection(const PerspectiveParams& params)
    : rotation_(orthogonal_part(params.to_world, "sensor")),
      origin_(params.to_world.translation()),
      near_clip_(params.near_clip),
      far_clip_(params.far_clip) {
    require(params.width > 0 && params.height > 0, "the film's size must be positive");
    require(params.fov > 0 && params.fov < 180, "fov must lie between 0 and 180 degrees");
    require(params.near_clip >= 0 && params.near_clip < params.far_clip, "near_clip must be less than far_clip");
    require(params.principal_point_offset.allFinite(), "the principal point must be finite");
    pixels_ = fov_extent(params) / (2 * std::tan(params.fov * (pi / 360)));
    // Mitsuba adds the offset to the film position before the lookup: a positive one moves the axis left and up.
    const Vec2 size(params.width, params.height);
    center_ = size.cwiseProduct(Vec2(0.5, 0.5) - params.principal_point_offset);
}

}  // namespace keyhole
