// A scene that is scaled and moved as a whole renders the same image, from the same random numbers path by path.
#include <gtest/gtest.h>

#include <cmath>

#include "render/render.h"
#include "scene/scene_builder.h"

namespace keyhole {
namespace {

// A closed room with a lamp, a glass ball and a glossy box, seen from within.
std::unique_ptr<Scene> room(double scale, const Vec3& offset) {
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

class ScaledAndMoved : public testing::TestWithParam<Integrator> {};

TEST_P(ScaledAndMoved, RendersTheSameImage) {
    RenderSettings settings;
    settings.integrator = GetParam();
    settings.mutations_per_pixel = 64;
    settings.mix.lengths.max = 6;
    const Image expected = render(*room(1, {0, 0, 0}), settings).image;
    struct Place {
        double scale;
        Vec3 offset;
    };
    // Places that floats hold with few digits left for the room, were its coordinates not taken from its own middle.
    for (const Place& place : {Place{1e-6, {0, 0, 0}}, Place{1e6, {0, 0, 0}}, Place{1, {1e4, -2e4, 0.5e4}},
                               Place{1e-2, {300, 100, -500}}, Place{1e6, {2e9, 0, 1e9}}}) {
        const RenderResult result = render(*room(place.scale, place.offset), settings);
        EXPECT_EQ(result.statistics.non_finite, 0U);
        double difference = 0, sum = 0;
        for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
            difference += std::abs(result.image.rgb[i] - expected.rgb[i]);
            sum += expected.rgb[i];
        }
        // A few of the paths pass an edge on the other side, one in 10^5 or so.
        EXPECT_LE(difference / sum, 2e-3) << "scale " << place.scale << " at " << place.offset.transpose();
    }
}

INSTANTIATE_TEST_SUITE_P(Unbiased, ScaledAndMoved, testing::Values(Integrator::path, Integrator::bdpt));

}  // namespace
}  // namespace keyhole
