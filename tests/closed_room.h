// A room for tests of what must not depend on a scene's size and place.
#pragma once

#include <memory>

#include "scene/scene_builder.h"

namespace keyhole {

// A closed room from -1 to 1 with a lamp, a glass ball and a glossy box, seen from within; scaled, then moved.
inline std::unique_ptr<Scene> closed_room(double scale = 1, const Vec3& offset = {0, 0, 0}) {
    const Affine world(Eigen::Translation3d(offset) * Eigen::UniformScaling<double>(scale));
    const auto placed = [&](const Affine& local, BsdfPtr bsdf) {
        ShapeOptions options;
        options.to_world = world * local;
        options.bsdf = std::move(bsdf);
        return options;
    };
    SceneBuilder builder;
    ShapeOptions walls = placed(Affine::Identity(), make_diffuse(Spectrum(0.7, 0.5, 0.4)));
    walls.flip_normals = true;
    builder.add_cube(walls);
    ShapeOptions lamp = placed(Affine(Eigen::Translation3d(0, 0.9, 0) * Eigen::AngleAxisd(pi / 2, Vec3::UnitX()) *
                                      Eigen::UniformScaling<double>(0.3)),
                               nullptr);
    lamp.radiance = ColorInput(Spectrum(5, 5, 5));
    builder.add_rectangle(lamp);
    builder.add_sphere({-0.4, -0.6, 0}, 0.35,
                       placed(Affine::Identity(), make_dielectric(1.5, Spectrum(1, 1, 1), Spectrum(1, 1, 1))));
    builder.add_cube(placed(Affine(Eigen::Translation3d(0.4, -0.7, -0.3) * Eigen::AngleAxisd(0.5, Vec3::UnitY()) *
                                   Eigen::UniformScaling<double>(0.29)),
                            make_rough_conductor(MicrofacetType::ggx, 0.2, 0.2, {}, Spectrum(1, 1, 1))));
    PerspectiveParams camera;
    camera.to_world = world * Affine(Eigen::Translation3d(0, 0, 0.95) * Eigen::AngleAxisd(pi, Vec3::UnitY()));
    camera.width = camera.height = 24;
    camera.fov = 80;
    camera.near_clip = 1e-3 * scale;
    camera.far_clip = 1e3 * scale;
    FilmSettings film;
    film.width = film.height = film.crop_width = film.crop_height = 24;
    builder.set_sensor(make_perspective_sensor(camera), film);
    return builder.build();
}

}  // namespace keyhole
