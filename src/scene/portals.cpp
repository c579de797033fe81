#include "scene/portals.h"

#include <cmath>
#include <stdexcept>

#include "base/warp.h"

namespace keyhole {
namespace {

PortalFace face(const Vec3& p, const Vec3& e1, const Vec3& e2, bool is_triangle) {
    const Vec3 normal = e1.cross(e2);
    const double length = normal.norm();
    return {p,
            e1,
            e2,
            is_triangle,
            0,
            length > 0 ? Vec3(normal / length) : Vec3::Zero(),
            is_triangle ? 0.5 * length : length};
}

}  // namespace

PortalFace parallelogram(const Vec3& p, const Vec3& e1, const Vec3& e2) { return face(p, e1, e2, false); }
PortalFace triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return face(a, b - a, c - a, true); }

Vec2 PortalFace::coordinates(const Vec3& x) const {
    const Vec3 r = x - p, normal = e1.cross(e2);
    const double inverse = 1 / normal.squaredNorm();
    return {r.cross(e2).dot(normal) * inverse, e1.cross(r).dot(normal) * inverse};
}

std::optional<Vec2> PortalFace::crossing(const Vec3& o, const Vec3& d, double t_max) const {
    const double towards = n.dot(d);
    if (towards == 0) return std::nullopt;
    const double t = n.dot(p - o) / towards;
    if (!(t > 0 && t < t_max)) return std::nullopt;
    const Vec2 ab = coordinates(o + t * d);
    return holds(ab) ? std::optional(ab) : std::nullopt;
}

void Portals::add(const std::string& name, std::vector<PortalFace> faces) {
    const auto portal = static_cast<std::uint32_t>(names_.size());
    double area = 0;
    for (PortalFace& f : faces) {
        f.portal = portal;
        area += f.area;
    }
    if (!(area > 0 && std::isfinite(area))) throw std::invalid_argument("a portal must have an area");
    std::erase_if(faces, [](const PortalFace& f) { return !(f.area > 0); });
    first_.push_back(static_cast<std::uint32_t>(faces_.size()));
    faces_.insert(faces_.end(), faces.begin(), faces.end());
    names_.push_back(name);
    areas_.push_back(area);
}

Portals::Point Portals::sample(std::uint32_t portal, double u_face, const Vec2& u) const {
    std::uint32_t i = first_[portal];
    const std::uint32_t last =
        portal + 1 < first_.size() ? first_[portal + 1] - 1 : static_cast<std::uint32_t>(faces_.size() - 1);
    for (double left = u_face * areas_[portal] - faces_[i].area; left >= 0 && i < last; left -= faces_[i].area) ++i;
    const PortalFace& f = faces_[i];
    // Barycentric coordinates of the second and third corner.
    return {i, f.at(f.triangle ? square_to_triangle(u) : u)};
}

}  // namespace keyhole
