// A hierarchy of boxes about all triangles of a scene in world space, for questions that Embree's own does not answer.
// Instances are counted out; shapes given by an equation count as the triangles of a fine net on them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
#include "base/vec.h"

namespace keyhole {

class EmbreeScene;

class BoxHierarchy {
  public:
    // Up to eight boxes beside each other, each about another node or about one triangle. Without a box, a lane's lower
    // corner is above its upper one.
    struct Node {
        std::array<Float8, 3> lower, upper;
        std::array<std::uint32_t, lanes> content{};  // an index of a node or triangle
        std::uint8_t boxes = 0, leaves = 0;          // bits of the lanes that hold one; of those about a triangle

        bool leaf(int lane) const { return leaves >> lane & 1; }
        Eigen::AlignedBox3d box(int lane) const {
            return {Vec3(lower[0][lane], lower[1][lane], lower[2][lane]),
                    Vec3(upper[0][lane], upper[1][lane], upper[2][lane])};
        }
    };
    using Triangle = std::array<Vec3, 3>;

    // `origin` is added to what the scene's shapes have for coordinates.
    BoxHierarchy(const EmbreeScene& scene, const Vec3& origin);
    explicit BoxHierarchy(std::vector<Triangle> triangles);

    bool empty() const { return nodes_.empty(); }
    const Node& root() const { return nodes_[0]; }
    const Node& child(const Node& node, int lane) const { return nodes_[content(node, lane)]; }
    const Triangle& triangle(const Node& node, int lane) const { return triangles_[content(node, lane)]; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    std::size_t bytes() const { return nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(Triangle); }

  private:
    static std::uint32_t content(const Node& node, int lane) { return node.content[static_cast<std::size_t>(lane)]; }
    void build();

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace keyhole
