#include "scene/shapes/mesh_primitives.h"

namespace keyhole {
namespace {

// Corners counter-clockwise as seen from outside, with their uv.
void add_quad(Mesh& mesh, const std::array<Vec3f, 4>& corners, const std::array<Vec2f, 4>& uvs, bool mirrored) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
    const std::uint32_t b = mirrored ? 2 : 1, c = mirrored ? 1 : 2, d = mirrored ? 3 : 2, e = mirrored ? 2 : 3;
    mesh.triangles.push_back({first, first + b, first + c});
    mesh.triangles.push_back({first, first + d, first + e});
}

}  // namespace

std::shared_ptr<const Mesh> rectangle_mesh(bool mirrored) {
    auto mesh = std::make_shared<Mesh>();
    add_quad(*mesh, {Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 1, 0), Vec3f(-1, 1, 0)},
             {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)}, mirrored);
    return mesh;
}

std::shared_ptr<const Mesh> cube_mesh(bool mirrored) {
    // The first corner of each face and its two edges: u runs along the first, 1 - v along the second (as Mitsuba's).
    struct Face {
        Vec3f corner, first, second;
    };
    const Face faces[] = {
        {{1, -1, -1}, {0, 0, 2}, {-2, 0, 0}},  // -y
        {{1, 1, -1}, {-2, 0, 0}, {0, 0, 2}},   // +y
        {{1, -1, -1}, {0, 2, 0}, {0, 0, 2}},   // +x
        {{1, -1, 1}, {0, 2, 0}, {-2, 0, 0}},   // +z
        {{-1, -1, 1}, {0, 2, 0}, {0, 0, -2}},  // -x
        {{1, 1, -1}, {0, -2, 0}, {-2, 0, 0}},  // -z
    };
    auto mesh = std::make_shared<Mesh>();
    for (const Face& f : faces) {
        add_quad(*mesh, {f.corner, f.corner + f.first, f.corner + f.first + f.second, f.corner + f.second},
                 {Vec2f(0, 1), Vec2f(1, 1), Vec2f(1, 0), Vec2f(0, 0)}, mirrored);
    }
    return mesh;
}

}  // namespace keyhole
