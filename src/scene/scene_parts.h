// What a SceneBuilder has been given. scene_builder.cpp collects it, scene_assembly.cpp makes a Scene of it.
#pragma once

#include <unordered_map>
#include <unordered_set>

#include "scene/scene_builder.h"
#include "scene/shapes/analytic_shape.h"
#include "scene/shapes/mesh_shape.h"

namespace keyhole {

struct SceneBuilder::Parts {
    static constexpr int top_level = -1;

    struct Item {
        std::shared_ptr<const Mesh> mesh;         // either this
        std::unique_ptr<AnalyticShape> analytic;  // or this
        ShapeOptions options;
        int group = top_level;
        bool instanced = false;          // a mesh that shares its hierarchy with other uses of it
        std::unique_ptr<Shape> shape{};  // made by build()
    };
    struct Instance {
        int group;
        Affine to_world;
    };

    Vec3 origin{0, 0, 0};
    std::vector<Item> items;
    std::vector<std::string> groups;  // ids
    int current_group = top_level;
    std::vector<Instance> instances;                 // of groups
    std::vector<std::shared_ptr<Emitter>> emitters;  // other than area
    bool has_environment = false;                    // among them
    Portals portals;
    std::unordered_set<const Mesh*> checked;
    std::unordered_map<const Mesh*, std::unique_ptr<MeshShape>> shared;  // of the instanced meshes, in their own space
    BsdfPtr default_bsdf;
    std::unique_ptr<Sensor> sensor;
    FilmSettings film;
    int max_path_length = 0;
    std::uint64_t content_hash = 0;
    bool robust = false;
    std::size_t textures = 0, texture_bytes = 0;

    // build(), step by step
    Vec3 choose_origin() const;
    void move_to(const Vec3& origin);
    void choose_instanced_meshes();
    void make_shapes();
    void fill_hierarchy(EmbreeScene& embree) const;
    Requirements requirements() const;
    SceneStatistics statistics() const;
};

}  // namespace keyhole
