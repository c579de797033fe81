// Every emitter of the scene reader. One file of emitters/ each.
#pragma once

#include <memory>
#include <string>

#include "scene/emitter.h"
#include "scene/texture.h"

namespace keyhole {

class Shape;

// One-sided: emits to the side of the surface's normal. Points are uniform in area, directions cosine-weighted.
std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, ColorInput radiance);
std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Spectrum& intensity);
// Falls off linearly in angle from `beam_width` to `cutoff_angle` (degrees, half-angles), as Mitsuba's.
// `to_world` maps the local axis +z. The scale of `to_world` is ignored. Throws std::invalid_argument for a singular
// one and for angles outside 0 <= beam_width <= cutoff_angle <= 180.
std::unique_ptr<Emitter> make_spot_emitter(const Affine& to_world, const Spectrum& intensity, double cutoff_angle,
                                           double beam_width);
// `direction`: in which the light travels, of any length but zero (std::invalid_argument).
std::unique_ptr<Emitter> make_directional_emitter(const Vec3& direction, const Spectrum& irradiance);
std::unique_ptr<Emitter> make_constant_emitter(const Spectrum& radiance);

struct EnvmapParams {
    std::string filename;  // latitude-longitude image, up is +y
    double scale = 1;
    Affine to_world = Affine::Identity();
};
// Radiance is bilinear between texel centres. Directions are drawn with a density close to its luminance: bilinear
// between the same corners in azimuth and in the cosine of the polar angle, exact and positive where the luminance is.
// Throws InputError as make_bitmap does and std::invalid_argument for a negative scale or a sheared to_world.
std::unique_ptr<Emitter> make_envmap_emitter(const EnvmapParams& params);

}  // namespace keyhole
