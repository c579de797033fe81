// Portals: surfaces that light passes through, such as an opening in a wall. Rays do not see them; they only tell moves
// in path space about which point of an edge to turn it.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"

namespace keyhole {

// A parallelogram p + a e1 + b e2 with a, b in [0, 1], or the triangle a + b <= 1 of it.
struct PortalFace {
    Vec3 p, e1, e2;
    bool triangle = false;
    std::uint32_t portal = 0;  // index in Portals::names()
    Vec3 n;                    // unit normal
    double area = 0;

    bool holds(const Vec2& ab) const {
        return ab.x() >= 0 && ab.y() >= 0 && (triangle ? ab.x() + ab.y() <= 1 : ab.x() <= 1 && ab.y() <= 1);
    }
    Vec3 at(const Vec2& ab) const { return p + ab.x() * e1 + ab.y() * e2; }
    // The coordinates (a, b) of a point of the plane.
    Vec2 coordinates(const Vec3& x) const;
    // Where the line o + t d meets the plane within the face, for 0 < t < t_max. Empty also where it is parallel.
    std::optional<Vec2> crossing(const Vec3& o, const Vec3& d, double t_max) const;
};

class Portals {
  public:
    // A portal of the given faces. Throws std::invalid_argument for one without area.
    void add(const std::string& name, std::vector<PortalFace> faces);

    bool empty() const { return faces_.empty(); }
    std::span<const PortalFace> faces() const { return faces_; }
    const std::vector<std::string>& names() const { return names_; }
    double area(std::uint32_t portal) const { return areas_[portal]; }

    // A point uniform over the portal by three numbers of [0, 1); the index of its face.
    struct Point {
        std::uint32_t face;
        Vec3 p;
    };
    Point sample(std::uint32_t portal, double u_face, const Vec2& u) const;

  private:
    std::vector<PortalFace> faces_;  // of one portal beside each other
    std::vector<std::uint32_t> first_;
    std::vector<std::string> names_;
    std::vector<double> areas_;
};

PortalFace parallelogram(const Vec3& p, const Vec3& e1, const Vec3& e2);
PortalFace triangle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace keyhole
