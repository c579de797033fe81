// Assembles a Scene. The readers and the tests use it; a Scene never changes after build().
#pragma once

#include <map>

#include "scene/emitters.h"
#include "scene/scene.h"

namespace keyhole {

class AnalyticShape;

struct ShapeOptions {
    std::string id;
    Affine to_world = Affine::Identity();
    bool flip_normals = false;
    bool face_normals = false;           // meshes: ignore vertex normals
    BsdfPtr bsdf;                        // null: diffuse, reflectance 0.5 (Mitsuba's default)
    std::optional<ColorInput> radiance;  // makes the shape an area emitter
};

class SceneBuilder {
  public:
    SceneBuilder();
    ~SceneBuilder();

    // Shapes. A mesh given several times (the same pointer) is instanced through Embree where that saves more memory
    // than it costs in speed. Throw std::invalid_argument for a singular or, where a shape cannot have it, sheared or
    // non-uniformly scaled transform, a mesh without triangles, with indices out of range or values not finite.
    void add_mesh(std::shared_ptr<const Mesh> mesh, const ShapeOptions& options);
    void add_rectangle(const ShapeOptions& options);  // [-1,1]^2 in z = 0, normal +z
    void add_cube(const ShapeOptions& options);       // [-1,1]^3
    void add_sphere(const Vec3& center, double radius, const ShapeOptions& options);
    void add_disk(const ShapeOptions& options);  // unit disk in z = 0, normal +z
    void add_cylinder(const Vec3& p0, const Vec3& p1, double radius, const ShapeOptions& options);  // open

    // Shapes between begin_group and end_group belong to the group and are seen only through instances of it.
    void begin_group(const std::string& id);
    void end_group();
    void add_instance(const std::string& group_id, const Affine& to_world);

    // Invisible: see portals.h. Throws std::invalid_argument for one without area.
    void add_portal(const std::string& name, std::vector<PortalFace> faces);

    void add_emitter(std::unique_ptr<Emitter> emitter);  // other than area; at most one environment
    void set_sensor(std::unique_ptr<Sensor> sensor, const FilmSettings& film);
    void set_max_path_length(int edges);
    void set_robust(bool robust);  // watertight but slower ray queries; off by default
    void set_texture_statistics(std::size_t count, std::size_t bytes);
    void set_content_hash(std::uint64_t hash);

    // Builds Embree's hierarchy (in parallel) and the emitter distribution. Throws std::invalid_argument if there is no
    // sensor. A scene without emitters is valid (and black).
    std::unique_ptr<Scene> build();

  private:
    struct Parts;  // scene_parts.h
    void add_shape(std::shared_ptr<const Mesh> mesh, std::unique_ptr<AnalyticShape> analytic,
                   const ShapeOptions& options);
    static void set_selection_probabilities(Scene& scene, std::span<const std::shared_ptr<Emitter>> emitters);
    std::unique_ptr<Parts> parts_;
};

}  // namespace keyhole
