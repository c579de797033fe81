// Small scenes and meshes for the tests of the scene's geometry.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "base/rng.h"
#include "base/warp.h"
#include "scene/scene_builder.h"

namespace keyhole {

// Any sensor will do: the tests shoot their own rays.
inline std::unique_ptr<Scene> build_with_sensor(SceneBuilder& builder) {
    builder.set_sensor(make_perspective_sensor({}), {});
    return builder.build();
}

inline ShapeOptions placed(const Affine& to_world) {
    ShapeOptions options;
    options.to_world = to_world;
    return options;
}

// A rotation about a skew axis, a uniform scale and a translation.
inline Affine similarity(double angle, double scale, const Vec3& translation) {
    return Affine(Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle, Vec3(1, -2, 0.7).normalized()) *
                  Eigen::UniformScaling<double>(scale));
}

inline Vec2 uniform2(Rng& rng) {
    const double x = rng.uniform();
    return {x, rng.uniform()};
}

inline Vec3 uniform_direction(Rng& rng) { return square_to_sphere(uniform2(rng)); }

// A unit sphere of 8 * 4^levels triangles, convex, wound outward.
inline std::shared_ptr<Mesh> octasphere(int levels, bool with_normals) {
    auto mesh = std::make_shared<Mesh>();
    for (const Vec3& p :
         {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
        mesh->positions.push_back(p.cast<float>());
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        mesh->triangles.push_back({i, (i + 1) % 4, 4});
        mesh->triangles.push_back({(i + 1) % 4, i, 5});
    }
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, added] = middles.try_emplace(std::minmax(a, b), 0);
            if (added) {
                const Vec3 p = (mesh->positions[a] + mesh->positions[b]).cast<double>().normalized();
                entry->second = static_cast<std::uint32_t>(mesh->positions.size());
                mesh->positions.push_back(p.cast<float>());
            }
            return entry->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh->triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh->triangles = std::move(finer);
    }
    if (with_normals) mesh->normals = mesh->positions;
    return mesh;
}

}  // namespace keyhole
