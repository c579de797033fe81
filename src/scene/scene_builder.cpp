#include "scene/scene_builder.h"

#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "scene/scene_parts.h"
#include "scene/shapes/cylinder.h"
#include "scene/shapes/disk.h"
#include "scene/shapes/mesh_primitives.h"
#include "scene/shapes/sphere.h"

namespace keyhole {

SceneBuilder::SceneBuilder() : parts_(std::make_unique<Parts>()) {}
SceneBuilder::~SceneBuilder() = default;

void SceneBuilder::add_shape(std::shared_ptr<const Mesh> mesh, std::unique_ptr<AnalyticShape> analytic,
                             const ShapeOptions& options) {
    if (options.radiance && parts_->current_group != Parts::top_level) {
        throw std::invalid_argument("an emitter cannot be part of a shape group");
    }
    parts_->items.push_back({std::move(mesh), std::move(analytic), options, parts_->current_group});
    BsdfPtr& bsdf = parts_->items.back().options.bsdf;
    if (bsdf) return;
    if (!parts_->default_bsdf) parts_->default_bsdf = make_diffuse(Spectrum(0.5, 0.5, 0.5));
    bsdf = parts_->default_bsdf;
}

void SceneBuilder::add_mesh(std::shared_ptr<const Mesh> mesh, const ShapeOptions& options) {
    check_invertible(options.to_world, "mesh");
    const Mesh* address = mesh.get();
    if (!parts_->checked.contains(address)) check_mesh(*mesh);
    add_shape(std::move(mesh), nullptr, options);
    parts_->checked.insert(address);  // only of a mesh that is kept: another may get the address of one refused
}

void SceneBuilder::add_rectangle(const ShapeOptions& options) {
    add_mesh(rectangle_mesh(options.to_world.linear().determinant() < 0), options);
}

void SceneBuilder::add_cube(const ShapeOptions& options) {
    add_mesh(cube_mesh(options.to_world.linear().determinant() < 0), options);
}

void SceneBuilder::add_sphere(const Vec3& center, double radius, const ShapeOptions& options) {
    add_shape(nullptr, std::make_unique<Sphere>(center, radius, options.to_world), options);
}

void SceneBuilder::add_disk(const ShapeOptions& options) {
    add_shape(nullptr, std::make_unique<Disk>(options.to_world), options);
}

void SceneBuilder::add_cylinder(const Vec3& p0, const Vec3& p1, double radius, const ShapeOptions& options) {
    add_shape(nullptr, std::make_unique<Cylinder>(p0, p1, radius, options.to_world), options);
}

void SceneBuilder::begin_group(const std::string& id) {
    if (parts_->current_group != Parts::top_level)
        throw std::invalid_argument("a shape group cannot hold a shape group");
    for (const std::string& name : parts_->groups) {
        if (name == id) throw std::invalid_argument("there is a shape group '" + id + "' already");
    }
    parts_->current_group = static_cast<int>(parts_->groups.size());
    parts_->groups.push_back(id);
}

void SceneBuilder::end_group() { parts_->current_group = Parts::top_level; }

void SceneBuilder::add_instance(const std::string& group_id, const Affine& to_world) {
    if (parts_->current_group != Parts::top_level) throw std::invalid_argument("a shape group cannot hold an instance");
    check_invertible(to_world, "instance");
    for (std::size_t i = 0; i < parts_->groups.size(); ++i) {
        if (parts_->groups[i] != group_id) continue;
        parts_->instances.push_back({static_cast<int>(i), to_world});
        return;
    }
    throw std::invalid_argument("there is no shape group '" + group_id + "'; " + valid_names(group_id, parts_->groups));
}

void SceneBuilder::add_emitter(std::unique_ptr<Emitter> emitter) {
    if (emitter->traits().environment && std::exchange(parts_->has_environment, true))
        throw std::invalid_argument("a scene can have only one environment emitter");
    parts_->emitters.push_back(std::move(emitter));
}

void SceneBuilder::add_portal(const std::string& name, std::vector<PortalFace> faces) {
    if (parts_->current_group != Parts::top_level)
        throw std::invalid_argument("a portal cannot be part of a shape group");
    parts_->portals.add(name, std::move(faces));
}

void SceneBuilder::set_sensor(std::unique_ptr<Sensor> sensor, const FilmSettings& film) {
    parts_->sensor = std::move(sensor);
    parts_->film = film;
}

void SceneBuilder::set_max_path_length(int edges) { parts_->max_path_length = edges; }
void SceneBuilder::set_content_hash(std::uint64_t hash) { parts_->content_hash = hash; }
void SceneBuilder::set_robust(bool robust) { parts_->robust = robust; }
void SceneBuilder::set_texture_statistics(std::size_t count, std::size_t bytes) {
    parts_->textures = count;
    parts_->texture_bytes = bytes;
}

}  // namespace keyhole
