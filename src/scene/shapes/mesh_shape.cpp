#include "scene/shapes/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/warp.h"
#include "scene/instance.h"
#include "scene/shapes/shading_frame.h"

namespace keyhole {
namespace {

constexpr double float_ulp = 0x1p-24;  // largest relative rounding error of a float

Vec3 lift(const Vec3f& v) { return v.cast<double>(); }

// Of a product e1 x e2: the sum of the magnitudes that each component is the difference of.
Vec3 cross_magnitude(const Vec3& e1, const Vec3& e2) {
    const Vec3 a = e1.cwiseAbs(), b = e2.cwiseAbs();
    return {a.y() * b.z() + a.z() * b.y(), a.z() * b.x() + a.x() * b.z(), a.x() * b.y() + a.y() * b.x()};
}

}  // namespace

struct MeshShape::Triangle : Corner {
    Vec3 cross() const { return e1.cross(e2); }

    // Barycentric coordinates of the second and third corner at p; n is any normal.
    Vec2 barycentrics(const Vec3& p, const Vec3& n) const {
        const Vec3 r = p - v0;
        const double inv = 1 / cross().dot(n);
        return {r.cross(e2).dot(n) * inv, e1.cross(r).dot(n) * inv};
    }

    // How far the float query may put the plane from a point of it, as a distance along the normal, is at most
    // weight.(16 |p| + 8 |p - v0|): the worst case of the rounding of the ray's origin and direction, of the edges, of
    // their cross product (ill conditioned for slivers: beyond a factor of 64 the sliver is too thin for its error to
    // show) and of the dot products with it. Components stay apart, so that axis-aligned planes have small bounds.
    // They have a floor, small beside a float's error, for planes next to zero: there a point that was computed along a
    // ray, and another sheet in the same plane, is off by more than the bound.
    Vec3 error_weight(double length) const {
        constexpr double floor = 0x1p-20;
        return float_ulp / length * cross_magnitude(e1, e2).cwiseMax(floor * length).cwiseMin(64 * length);
    }
    Vec3 extent() const { return e1.cwiseAbs().cwiseMax(e2.cwiseAbs()); }
};

MeshShape::MeshShape(std::shared_ptr<const Mesh> mesh, const Affine& to_world, bool face_normals, Seen seen)
    : Shape(true),
      mesh_(std::move(mesh)),
      positions_(mesh_->positions),
      uvs_(mesh_->uvs),
      triangles_(mesh_->triangles) {
    if (!face_normals) normals_ = mesh_->normals;
    copy_transformed(to_world);
    collapse_degenerate_triangles();
    if (seen == Seen::directly) make_planes();
}

MeshShape::MeshShape(const MeshShape& storage, bool face_normals)
    : Shape(true),
      mesh_(storage.mesh_),
      positions_(storage.positions_),
      normals_(face_normals ? std::span<const Vec3f>() : storage.normals_),
      uvs_(storage.uvs_),
      triangles_(storage.triangles_) {}

void MeshShape::copy_transformed(const Affine& to_world) {
    const bool moved = to_world.matrix() != Affine::Identity().matrix();
    // Embree reads 16 bytes at the last vertex.
    if (moved || mesh_->positions.capacity() == mesh_->positions.size()) {
        own_positions_.reserve(positions_.size() + 1);
        for (const Vec3f& p : positions_) own_positions_.push_back((to_world * lift(p)).cast<float>());
        positions_ = own_positions_;
    }
    if (moved && !normals_.empty()) {
        const Eigen::Matrix3d inverse_transpose = to_world.linear().inverse().transpose();
        own_normals_.reserve(normals_.size());
        for (const Vec3f& n : normals_)
            own_normals_.push_back((inverse_transpose * lift(n)).normalized().cast<float>());
        normals_ = own_normals_;
    }
    for (const Vec3f& p : positions_) {
        if (!p.allFinite())
            throw std::invalid_argument("mesh: the transform takes positions out of the range of float");
    }
}

// A triangle that is degenerate in double precision may still be hit in float: collapsed to a point it never is.
void MeshShape::collapse_degenerate_triangles() {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        if (triangle(i, nullptr).cross().squaredNorm() > 0) continue;
        if (own_triangles_.empty()) {
            own_triangles_ = mesh_->triangles;
            triangles_ = own_triangles_;
        }
        own_triangles_[i].fill(own_triangles_[i][0]);
    }
}

void MeshShape::make_planes() {
    planes_.reserve(triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const Triangle f = triangle(i, nullptr);
        const Vec3 cross = f.cross();
        const double length = cross.norm();
        const Vec3 n = cross / length, weight = f.error_weight(length);
        planes_.push_back(
            {n, n.dot(f.v0), (16 * weight).cast<float>(), static_cast<float>(8 * weight.dot(f.extent()))});
    }
}

MeshShape::Triangle MeshShape::triangle(std::uint32_t primitive, const InstanceTransform* instance) const {
    const auto& index = triangles_[primitive];
    Vec3 v[3];
    for (int k = 0; k < 3; ++k) {
        v[k] = lift(positions_[index[k]]);
        if (instance) v[k] = instance->to_world * v[k];
    }
    return {{v[0], v[1] - v[0], v[2] - v[0]}};
}

double MeshShape::fill_through_instance(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const {
    const Triangle f = triangle(hit.primitive, hit.instance);
    const Vec3 n = f.cross().normalized();
    const Plane plane{.n = n, .c = n.dot(f.v0), .bound = {}, .bound0 = 0};
    const double t = plane.meet(ray, hit.t);
    x.p = plane.put_back(ray.o + t * ray.d);
    x.ng = n;
    x.primitive = hit.primitive;
    set_instance_offset(hit.primitive, *hit.instance, x);
    set_frame(hit, x);
    return t;
}

// Embree transforms the ray to the instance's space in float and tests it there.
void MeshShape::set_instance_offset(std::uint32_t primitive, const InstanceTransform& instance, SurfacePoint& x) const {
    const Triangle f = triangle(primitive, nullptr);
    const Vec3 cross = f.cross();
    const double length = cross.norm();
    const Vec3 magnitude = instance.magnitude * (x.p.cwiseAbs() + instance.to_world.translation().cwiseAbs());
    const Vec3 weight = f.error_weight(length);
    const double to_world = 1 / (instance.normal * cross / length).norm();
    const double local = weight.dot(16 * ((instance.to_local * x.p).cwiseAbs() + magnitude) + 8 * f.extent());
    const double local_per_length =
        (weight.transpose() * (instance.to_local.linear().cwiseAbs() + instance.magnitude)).sum();
    x.offset = static_cast<float>(local * to_world);
    x.offset_per_length = static_cast<float>(16 * Plane::target_share * local_per_length * to_world);
}

// x.ng is the triangle's; the shading normal decides its side.
void MeshShape::set_frame(const ShapeHit& hit, SurfacePoint& x) const {
    if (flat()) return set_flat_frame(x);
    const Triangle f = triangle(hit.primitive, hit.instance);
    const Vec2 b = f.barycentrics(x.p, x.ng);
    Vec3 n;
    if (normals_.empty() || !shading_normal(hit.primitive, hit.instance, b, n)) {
        if (flip_normals) x.ng = -x.ng;
        n = x.ng;
    } else if (n.dot(x.ng) < 0) {
        x.ng = -x.ng;
    }
    if (needs_uv) x.uv = uv(hit.primitive, b);
    if (needs_tangents) {
        set_tangents(f, hit.primitive, n, x);
    } else {
        x.frame = Frame::from_normal(n);
    }
}

// False where the vertex normals cancel. Under an instance they are normalised before they are interpolated, as those
// of a copy under the same transform are: whether a mesh is copied or instanced does not show.
bool MeshShape::shading_normal(std::uint32_t primitive, const InstanceTransform* instance, const Vec2& b,
                               Vec3& n) const {
    const auto& index = triangles_[primitive];
    const auto normal = [&](int k) -> Vec3 {
        const Vec3 at_corner = lift(normals_[index[k]]);
        return instance ? (instance->normal * at_corner).normalized() : at_corner;
    };
    n = (1 - b.x() - b.y()) * normal(0) + b.x() * normal(1) + b.y() * normal(2);
    const double length2 = n.squaredNorm();
    if (!(length2 > 0)) return false;
    n *= (flip_normals ? -1 : 1) / std::sqrt(length2);
    return true;
}

Vec2 MeshShape::uv(std::uint32_t primitive, const Vec2& b) const {
    if (uvs_.empty()) return b;
    const auto& index = triangles_[primitive];
    const Vec2 uv0 = uvs_[index[0]].cast<double>();
    return uv0 + b.x() * (uvs_[index[1]].cast<double>() - uv0) + b.y() * (uvs_[index[2]].cast<double>() - uv0);
}

void MeshShape::set_tangents(const Triangle& f, std::uint32_t primitive, const Vec3& n, SurfacePoint& x) const {
    Vec3 dpdu = f.e1, dpdv = f.e2;  // uv are the barycentrics
    if (!uvs_.empty()) {
        const auto& index = triangles_[primitive];
        const Vec2 uv0 = uvs_[index[0]].cast<double>();
        const Vec2 d1 = uvs_[index[1]].cast<double>() - uv0, d2 = uvs_[index[2]].cast<double>() - uv0;
        const double determinant = d1.x() * d2.y() - d1.y() * d2.x();
        if (determinant == 0) {
            dpdu.setZero();
            dpdv.setZero();
        } else {
            dpdu = (d2.y() * f.e1 - d1.y() * f.e2) / determinant;
            dpdv = (d1.x() * f.e2 - d2.x() * f.e1) / determinant;
        }
    }
    set_shading_frame(x, n, true, dpdu, dpdv);
}

void MeshShape::prepare_sampling() {
    area_cdf_.clear();
    area_cdf_.reserve(triangles_.size());
    corners_.clear();
    corners_.reserve(triangles_.size());
    area_ = 0;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const Triangle f = triangle(i, nullptr);
        corners_.push_back(f);
        area_ += f.cross().norm() / 2;
        area_cdf_.push_back(area_);
    }
    if (!(area_ > 0)) throw std::invalid_argument("mesh: an emitter needs a surface area greater than zero");
    const auto last = std::lower_bound(area_cdf_.begin(), area_cdf_.end(), area_);
    last_with_area_ = static_cast<std::uint32_t>(last - area_cdf_.begin());
}

ShapeSample MeshShape::sample(double u_primitive, const Vec2& u) const {
    const auto found = std::upper_bound(area_cdf_.begin(), area_cdf_.end(), u_primitive * area_);
    const auto primitive = std::min(static_cast<std::uint32_t>(found - area_cdf_.begin()), last_with_area_);
    const Corner& f = corners_[primitive];
    const Plane& plane = planes_[primitive];
    const Vec2 b = square_to_triangle(u);
    ShapeSample s{f.v0 + b.x() * f.e1 + b.y() * f.e2, plane.n, needs_uv ? uv(primitive, b) : Vec2(0, 0)};
    s.primitive = primitive;
    plane.set_offset(s.p, s);
    Vec3 n;
    const bool smooth = !normals_.empty() && shading_normal(primitive, nullptr, b, n);
    if (smooth ? n.dot(s.ng) < 0 : flip_normals) s.ng = -s.ng;
    return s;
}

EmitterNumbers MeshShape::invert_sample(std::uint32_t primitive, const Vec3& p, const InverseNumbers& v) const {
    const double begin = primitive > 0 ? area_cdf_[primitive - 1] : 0, end = area_cdf_[primitive];
    const Vec2 b = triangle(primitive, nullptr).barycentrics(p, planes_[primitive].n);
    return {number_in_interval(v.place, begin / area_, end / area_), triangle_to_square(b)};
}

std::size_t Mesh::bytes() const {
    return (positions.size() + normals.size()) * sizeof(Vec3f) + uvs.size() * sizeof(Vec2f) +
           triangles.size() * sizeof(triangles[0]);
}

void check_mesh(const Mesh& mesh) {
    if (mesh.triangles.empty()) throw std::invalid_argument("mesh: no triangles");
    const std::size_t n = mesh.positions.size();
    const auto check_size = [&](const char* what, std::size_t size) {
        if (size == 0 || size == n) return;
        throw std::invalid_argument("mesh: " + std::to_string(size) + " " + what + " for " + std::to_string(n) +
                                    " vertices");
    };
    check_size("normals", mesh.normals.size());
    check_size("uv coordinates", mesh.uvs.size());
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) {
            if (index < n) continue;
            throw std::invalid_argument("mesh: vertex index " + std::to_string(index) + " is out of range, there are " +
                                        std::to_string(n) + " vertices");
        }
    }
    const auto check_finite = [](const char* what, const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].allFinite()) continue;
            throw std::invalid_argument("mesh: " + std::string(what) + " " + std::to_string(i) + " is not finite");
        }
    };
    check_finite("position", mesh.positions);
    check_finite("normal", mesh.normals);
    check_finite("uv coordinate", mesh.uvs);
}

std::size_t MeshShape::own_bytes() const {
    return (own_positions_.size() + own_normals_.size()) * sizeof(Vec3f) +
           own_triangles_.size() * sizeof(triangles_[0]) + planes_.size() * sizeof(Plane) +
           area_cdf_.size() * (sizeof(double) + sizeof(Corner));
}

}  // namespace keyhole
