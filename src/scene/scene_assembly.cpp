// SceneBuilder::build: shapes, emitters and Embree's hierarchy out of the collected parts.

#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "scene/embree.h"
#include "scene/scene_parts.h"

namespace keyhole {
namespace {

// Instances cost speed: uses of a mesh share one hierarchy only if that saves more than this.
constexpr std::size_t min_bytes_saved_by_instances = std::size_t{64} << 20;
// Embree's hierarchy over triangles.
constexpr std::size_t hierarchy_bytes_per_triangle = 96;

void unite(BsdfTraits& all, const BsdfTraits& one) {
    all.smooth |= one.smooth;
    all.delta |= one.delta;
    all.transmissive |= one.transmissive;
    all.chooses_lobe |= one.chooses_lobe;
    all.lobes = std::max(all.lobes, one.lobes);
    all.needs_uv |= one.needs_uv;
    all.needs_tangents |= one.needs_tangents;
}

}  // namespace

// Zero, unless the scene lies so far from it that floats would spend their digits on the way there: then a point near
// its middle, of few digits, so that subtracting it from floats is exact.
Vec3 SceneBuilder::Parts::choose_origin() const {
    std::unordered_map<const Mesh*, Eigen::AlignedBox3d> mesh_boxes;
    std::vector<Eigen::AlignedBox3d> group_boxes(groups.size());
    Eigen::AlignedBox3d box;
    for (const Item& item : items) {
        Eigen::AlignedBox3d own;
        if (item.mesh) {
            Eigen::AlignedBox3d& mesh_box = mesh_boxes[item.mesh.get()];
            if (mesh_box.isEmpty())
                for (const Vec3f& p : item.mesh->positions) mesh_box.extend(p.cast<double>());
            own = mesh_box.transformed(Eigen::Affine3d(item.options.to_world));
        } else {
            const auto [lower, upper] = item.analytic->bounds();
            own = {lower, upper};
        }
        (item.group == top_level ? box : group_boxes[static_cast<std::size_t>(item.group)]).extend(own);
    }
    for (const Instance& instance : instances) {
        const auto& group_box = group_boxes[static_cast<std::size_t>(instance.group)];
        if (!group_box.isEmpty()) box.extend(group_box.transformed(Eigen::Affine3d(instance.to_world)));
    }
    if (box.isEmpty()) return Vec3::Zero();
    const double radius = box.diagonal().norm() / 2, step = std::exp2(std::ceil(std::log2(radius)));
    constexpr double far = 8;  // radii
    if (!(box.center().norm() > far * radius) || !std::isfinite(step)) return Vec3::Zero();
    return (box.center() / step).array().round() * step;
}

void SceneBuilder::Parts::move_to(const Vec3& new_origin) {
    origin = new_origin;
    if (origin.isZero(0)) return;
    for (Item& item : items) {
        if (item.group != top_level) continue;
        item.options.to_world.pretranslate(-origin);
        if (item.analytic) item.analytic->translate(-origin);
    }
    for (Instance& instance : instances) instance.to_world.pretranslate(-origin);
}

// Emitters are sampled in world space and keep a copy of their own.
void SceneBuilder::Parts::choose_instanced_meshes() {
    const auto may_share = [](const Item& item) {
        return item.mesh && item.group == top_level && !item.options.radiance;
    };
    std::unordered_map<const Mesh*, std::size_t> uses;
    for (const Item& item : items) {
        if (may_share(item)) ++uses[item.mesh.get()];
    }
    for (Item& item : items) {
        if (!may_share(item)) continue;
        const Mesh& mesh = *item.mesh;
        const std::size_t copy = (mesh.positions.size() + mesh.normals.size()) * sizeof(Vec3f) +
                                 mesh.triangles.size() * hierarchy_bytes_per_triangle;
        item.instanced = (uses[item.mesh.get()] - 1) * copy > min_bytes_saved_by_instances;
        if (item.instanced && !shared.contains(&mesh)) {
            shared[&mesh] =
                std::make_unique<MeshShape>(item.mesh, Affine::Identity(), false, MeshShape::Seen::through_instances);
        }
    }
}

void SceneBuilder::Parts::make_shapes() {
    choose_instanced_meshes();
    parallel_for(items.size(), [&](std::size_t i) {
        Item& item = items[i];
        const ShapeOptions& options = item.options;
        if (item.analytic) {
            item.shape = std::move(item.analytic);
        } else if (item.instanced) {
            item.shape = std::make_unique<MeshShape>(*shared.at(item.mesh.get()), options.face_normals);
        } else {
            const auto seen = item.group == top_level ? MeshShape::Seen::directly : MeshShape::Seen::through_instances;
            auto mesh_shape = std::make_unique<MeshShape>(item.mesh, options.to_world, options.face_normals, seen);
            if (options.radiance) mesh_shape->prepare_sampling();
            item.shape = std::move(mesh_shape);
        }
        Shape& shape = *item.shape;
        shape.origin = origin;
        shape.id = options.id;
        shape.bsdf = options.bsdf;
        shape.flip_normals = options.flip_normals;
        shape.needs_tangents = options.bsdf->traits().needs_tangents;
        shape.needs_uv = options.bsdf->traits().needs_uv || (options.radiance && options.radiance->texture);
        if (options.radiance) shape.emitter = make_area_emitter(shape, *options.radiance);
    });
}

void SceneBuilder::Parts::fill_hierarchy(EmbreeScene& embree) const {
    std::vector<EmbreeGroup*> hierarchies;
    for (std::size_t i = 0; i < groups.size(); ++i) hierarchies.push_back(&embree.new_group());
    std::unordered_map<const Mesh*, EmbreeGroup*> shared_hierarchies;
    for (const auto& [mesh, shape] : shared) {
        EmbreeGroup& group = embree.new_group();
        group.add(*shape);
        shared_hierarchies[mesh] = &group;
    }
    for (const Item& item : items) {
        if (item.instanced) {
            embree.add_instance(*shared_hierarchies.at(item.mesh.get()), item.shape.get(), item.options.to_world);
            continue;
        }
        EmbreeGroup& group =
            item.group == top_level ? embree.top() : *hierarchies[static_cast<std::size_t>(item.group)];
        if (item.mesh) {
            group.add(static_cast<const MeshShape&>(*item.shape));
        } else {
            group.add(static_cast<const AnalyticShape&>(*item.shape));
        }
    }
    for (const Instance& instance : instances) {
        embree.add_instance(*hierarchies[static_cast<std::size_t>(instance.group)], nullptr, instance.to_world);
    }
    embree.commit();
}

Requirements SceneBuilder::Parts::requirements() const {
    Requirements all;
    for (const Item& item : items) unite(all.bsdfs, item.options.bsdf->traits());
    all.aperture = sensor->traits().aperture;
    for (const auto& emitter : emitters) {
        all.environment |= emitter->traits().environment;
        all.infinite_emitters |= emitter->traits().infinite;
        all.delta_emitters |= emitter->traits().delta;
    }
    return all;
}

SceneStatistics SceneBuilder::Parts::statistics() const {
    SceneStatistics all;
    std::vector<std::size_t> group_triangles(groups.size(), 0);
    std::unordered_set<const Mesh*> meshes;
    std::unordered_set<const Bsdf*> bsdfs;
    for (const Item& item : items) {
        bsdfs.insert(item.options.bsdf.get());
        all.instances += item.instanced;
        if (!item.mesh) continue;
        const std::size_t triangles = item.mesh->triangles.size();
        (item.group == top_level ? all.triangles : group_triangles[static_cast<std::size_t>(item.group)]) += triangles;
        all.mesh_bytes += static_cast<const MeshShape&>(*item.shape).own_bytes();
        if (!meshes.insert(item.mesh.get()).second) continue;
        all.unique_triangles += triangles;
        all.mesh_bytes += item.mesh->bytes();
    }
    for (const auto& [mesh, shape] : shared) all.mesh_bytes += shape->own_bytes();
    for (const Instance& instance : instances)
        all.triangles += group_triangles[static_cast<std::size_t>(instance.group)];
    all.shapes = items.size();
    all.instances += instances.size();
    all.bsdfs = bsdfs.size();
    all.textures = textures;
    all.texture_bytes = texture_bytes;
    return all;
}

// Emitters are chosen by the luminance of their power; if all are black, uniformly.
void SceneBuilder::set_selection_probabilities(Scene& scene, std::span<const std::shared_ptr<Emitter>> emitters) {
    std::vector<double> power;
    double total = 0;
    for (const auto& emitter : emitters) {
        power.push_back(luminance(emitter->power()));
        if (!(power.back() >= 0) || !std::isfinite(power.back())) {
            throw std::invalid_argument(std::string("the power of the emitter '") + emitter->name() +
                                        "' is negative or not finite");
        }
        total += power.back();
    }
    if (total == 0) {
        power.assign(power.size(), 1);
        total = static_cast<double>(power.size());
    }
    if (!std::isfinite(total)) throw std::invalid_argument("the power of all emitters together is not finite");
    double sum = 0;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        sum += power[i];
        scene.emitter_cdf_.push_back(sum / total);  // the same sums as above: exactly 1 from the last bright one on
        emitters[i]->index_ = static_cast<std::uint32_t>(i);
        emitters[i]->selection_probability_ = power[i] / total;
        if (emitters[i]->traits().environment) scene.environment_ = emitters[i].get();
        scene.emitters_.push_back(emitters[i].get());
        scene.owned_emitters_.push_back(emitters[i]);
    }
}

std::unique_ptr<Scene> SceneBuilder::build() {
    Parts& parts = *parts_;
    if (!parts.sensor) throw std::invalid_argument("the scene has no sensor");
    parts.move_to(parts.choose_origin());
    parts.make_shapes();

    std::unique_ptr<Scene> scene(new Scene);
    scene->origin_ = parts.origin;
    scene->moved_ = !parts.origin.isZero(0);
    scene->embree_ = std::make_unique<EmbreeScene>(parts.robust);
    parts.fill_hierarchy(*scene->embree_);
    const auto [lower, upper] = scene->embree_->bounds();
    const bool empty = !(lower.array() <= upper.array()).all();
    scene->center_ = empty ? Vec3(0, 0, 0) : Vec3(parts.origin + (lower + upper) / 2);
    scene->radius_ = empty ? 1 : (upper - lower).norm() / 2;

    std::vector<std::shared_ptr<Emitter>> emitters;
    for (const Parts::Item& item : parts.items) {
        if (item.shape->emitter) emitters.push_back(item.shape->emitter);
    }
    emitters.insert(emitters.end(), parts.emitters.begin(), parts.emitters.end());
    for (const auto& emitter : emitters) emitter->set_scene_bounds(scene->center_, scene->radius_);
    set_selection_probabilities(*scene, emitters);

    scene->requirements_ = parts.requirements();
    scene->statistics_ = parts.statistics();
    scene->statistics_.emitters = emitters.size();
    scene->statistics_.embree_bytes = scene->embree_->bytes();
    scene->sensor_ = std::move(parts.sensor);
    scene->film_ = parts.film;
    scene->portals_ = std::move(parts.portals);
    scene->max_path_length_ = parts.max_path_length;
    scene->content_hash_ = parts.content_hash;
    for (Parts::Item& item : parts.items) scene->shapes_.push_back(std::move(item.shape));
    for (auto& [mesh, shape] : parts.shared) scene->shapes_.push_back(std::move(shape));
    parts_ = std::make_unique<Parts>();
    return scene;
}

}  // namespace keyhole
