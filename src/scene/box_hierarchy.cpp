#include "scene/box_hierarchy.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>

#include "base/parallel.h"
#include "scene/embree.h"
#include "scene/shapes/analytic_shape.h"
#include "scene/shapes/mesh_shape.h"

namespace keyhole {
namespace {

constexpr int net_size = 24;  // cells along each side of the net on a shape given by an equation

// Calls visit(a, b, c) with the corners of a shape's triangles, in its own space.
template <class Visit>
void for_each_triangle(const Shape& shape, const Visit& visit) {
    if (shape.is_mesh) {
        const auto& mesh = static_cast<const MeshShape&>(shape);
        for (const auto& corners : mesh.triangles()) {
            const auto at = [&](int i) -> Vec3 { return mesh.positions()[corners[i]].cast<double>(); };
            visit(at(0), at(1), at(2));
        }
        return;
    }
    std::vector<Vec3> net;
    for (int i = 0; i <= net_size; ++i)
        for (int j = 0; j <= net_size; ++j) {
            const auto side = [](int k) { return std::min(k / double(net_size), one_minus_epsilon); };
            net.push_back(shape.sample(0, {side(i), side(j)}).p - shape.origin);
        }
    for (int i = 0; i < net_size; ++i)
        for (int j = 0; j < net_size; ++j) {
            const std::size_t a = static_cast<std::size_t>(i * (net_size + 1) + j), b = a + net_size + 1;
            visit(net[a], net[a + 1], net[b]);
            visit(net[b], net[a + 1], net[b + 1]);
        }
}

// As the builder makes it; memory of the builder's.
struct BuiltNode {
    RTCBounds bounds[lanes];
    BuiltNode* children[lanes];
    unsigned count = 0;  // 0: a leaf
    std::uint32_t triangle = 0;
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), 16)) BuiltNode;
}
void set_children(void* node, void** children, unsigned count, void*) {
    auto* built = static_cast<BuiltNode*>(node);
    built->count = count;
    for (unsigned i = 0; i < count; ++i) built->children[i] = static_cast<BuiltNode*>(children[i]);
}
void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<BuiltNode*>(node)->bounds[i] = *bounds[i];
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t, void*) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), 16)) BuiltNode;
    leaf->triangle = primitives[0].primID;
    return leaf;
}

// Boxes hold their triangles although they are float.
float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace

BoxHierarchy::BoxHierarchy(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) { build(); }

BoxHierarchy::BoxHierarchy(const EmbreeScene& scene, const Vec3& origin) {
    scene.for_each_shape([&](const Shape& shape, const Affine& to_world) {
        for_each_triangle(shape, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
            triangles_.push_back({origin + to_world * a, origin + to_world * b, origin + to_world * c});
        });
    });
    build();
}

void BoxHierarchy::build() {
    if (triangles_.empty()) return;
    std::vector<RTCBuildPrimitive> primitives(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const auto& [a, b, c] = triangles_[i];
        const Vec3 lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
        primitives[i] = {below(lower.x()), below(lower.y()), below(lower.z()), 0,
                         above(upper.x()), above(upper.y()), above(upper.z()), static_cast<unsigned>(i)};
    }
    const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice(nullptr), rtcReleaseDevice);
    if (!device) throw std::runtime_error("Embree cannot create a device on this machine");
    const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = lanes;
    arguments.maxDepth = 64;
    arguments.minLeafSize = arguments.maxLeafSize = 1;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    auto* top = static_cast<BuiltNode*>(isolated([&] { return rtcBuildBVH(&arguments); }));
    if (!top) throw std::runtime_error("Embree cannot build a hierarchy of boxes");

    // Copied level by level. A leaf at the top is the only box of a node.
    BuiltNode above_top;
    above_top.count = 1;
    above_top.children[0] = top;
    const RTCBuildPrimitive& only = primitives[0];
    above_top.bounds[0] = {only.lower_x, only.lower_y, only.lower_z, 0, only.upper_x, only.upper_y, only.upper_z, 0};
    std::vector<const BuiltNode*> sources = {top->count == 0 ? &above_top : top};
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const BuiltNode& source = *sources[i];
        Node node;
        node.lower.fill(broadcast(infinity));
        node.upper.fill(broadcast(-infinity));
        for (unsigned lane = 0; lane < source.count; ++lane) {
            const RTCBounds& b = source.bounds[lane];
            const BuiltNode* child = source.children[lane];
            const float lower[] = {b.lower_x, b.lower_y, b.lower_z}, upper[] = {b.upper_x, b.upper_y, b.upper_z};
            for (std::size_t c = 0; c < 3; ++c) {
                node.lower[c][lane] = lower[c];
                node.upper[c][lane] = upper[c];
            }
            const auto bit = static_cast<std::uint8_t>(1u << lane);
            node.boxes |= bit;
            if (child->count == 0) {
                node.leaves |= bit;
                node.content[lane] = child->triangle;
            } else {
                node.content[lane] = static_cast<std::uint32_t>(sources.size());
                sources.push_back(child);
            }
        }
        nodes_.push_back(node);
    }
}

}  // namespace keyhole
