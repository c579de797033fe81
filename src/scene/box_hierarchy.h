// A hierarchy of boxes about all triangles of a scene in world space, for questions that Embree's own does not answer.
// Instances are counted out; shapes given by an equation count as the triangles of a fine net on them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace keyhole {

class EmbreeScene;

class BoxHierarchy {
  public:
    // A box, and either two children, at `first` and `first + 1`, or one triangle.
    struct Node {
        Vec3f lower, upper;
        std::uint32_t first = 0;
        bool leaf = false;
    };
    using Triangle = std::array<Vec3, 3>;

    // `origin` is added to what the scene's shapes have for coordinates.
    BoxHierarchy(const EmbreeScene& scene, const Vec3& origin);
    explicit BoxHierarchy(std::vector<Triangle> triangles);

    bool empty() const { return nodes_.empty(); }
    const Node& root() const { return nodes_[0]; }
    const Node& child(const Node& node, int i) const { return nodes_[node.first + static_cast<std::uint32_t>(i)]; }
    const Triangle& triangle(const Node& leaf) const { return triangles_[leaf.first]; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    std::size_t bytes() const { return nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(Triangle); }

  private:
    void build();

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace keyhole
