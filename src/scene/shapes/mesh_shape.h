// Triangle meshes, most of any scene: float positions as Embree sees them, hits in double precision.
#pragma once

#include <span>

#include "scene/shape.h"

namespace keyhole {

class MeshShape final : public Shape {
  public:
    // Planes of the triangles are kept only where rays hit the mesh directly.
    enum class Seen { directly, through_instances };

    // The mesh under `to_world`. A transform other than the identity makes the shape's own copy of positions and
    // normals; the rest stays shared. `face_normals` ignores vertex normals. Throws std::invalid_argument if the
    // transform leaves the range of float.
    MeshShape(std::shared_ptr<const Mesh> mesh, const Affine& to_world, bool face_normals, Seen seen);
    // Another look of the same mesh in the same space, seen through instances. `storage` must outlive it.
    MeshShape(const MeshShape& storage, bool face_normals);
    MeshShape(const MeshShape&) = delete;
    MeshShape& operator=(const MeshShape&) = delete;

    double fill(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const override {
        if (hit.instance) [[unlikely]]
            return fill_through_instance(ray, hit, x);
        const Plane& plane = planes_[hit.primitive];
        const double t = plane.meet(ray, hit.t);
        x.p = plane.put_back(ray.o + t * ray.d);
        plane.set_offset(x.p, x);
        x.ng = plane.n;
        x.primitive = hit.primitive;
        if (flat())
            set_flat_frame(x);
        else
            set_frame(hit, x);
        return t;
    }

    // Before sample() and area(), of a mesh seen directly. Throws std::invalid_argument if the area is zero.
    void prepare_sampling();
    double area() const override { return area_; }
    ShapeSample sample(double u_primitive, const Vec2& u) const override;

    EmitterNumbers invert_sample(std::uint32_t primitive, const Vec3& p, const InverseNumbers& v) const override;

    std::span<const Vec3f> positions() const { return positions_; }
    std::span<const std::array<std::uint32_t, 3>> triangles() const { return triangles_; }
    std::size_t own_bytes() const;  // without the shared mesh

  private:
    // A corner of a triangle and the edges from there.
    struct Corner {
        Vec3 v0, e1, e2;
    };
    struct Triangle;  // with what is computed from it
    // A triangle's plane n.p = c, and the error bound of float queries at a point p of it: bound.|p| + bound0. It takes
    // 48 bytes a triangle and, beside computing all this at each hit, 30 ns off a ray of 150 ns.
    struct Plane {
        // A ray that ends on a plane is tested against it from afar, with coordinates that are larger by the ray D. By
        // the worst case of error_weight that adds weight.(20 |D|): 1 for the rounding of its origin, 8 for the
        // products with what points from there to the triangle, 11 for those with its direction and for its length.
        static constexpr float target_share = 20 / 16.f;

        Vec3 n;
        double c;
        Vec3f bound;
        float bound0;

        // Of a point p on the plane.
        template <class Point>
        void set_offset(const Vec3& p, Point& x) const {
            x.offset = bound.dot(p.cast<float>().cwiseAbs()) + bound0;
            x.offset_per_length = target_share * bound.sum();
        }

        double distance(const Vec3& p) const { return c - n.dot(p); }

        // Where the ray meets the plane, close to `t_query`.
        double meet(const Ray& ray, double t_query) const {
            const double t = distance(ray.o) / n.dot(ray.d);
            // A ray in the plane has no distance to it, and one along it may start behind it by the query's error.
            return t > ray.tnear && t < ray.tfar ? t : t_query;
        }
        // A point's rounding error grows with its ray's coordinates, the bound of the offset only with the plane's: so
        // hits are put back onto the plane.
        Vec3 put_back(const Vec3& p) const { return p + distance(p) * n; }
    };

    bool flat() const { return normals_.empty() && !needs_uv && !needs_tangents; }
    void set_flat_frame(SurfacePoint& x) const {
        if (flip_normals) x.ng = -x.ng;
        x.frame = Frame::from_normal(x.ng);
    }
    double fill_through_instance(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const;
    void copy_transformed(const Affine& to_world);
    void collapse_degenerate_triangles();
    void make_planes();
    Triangle triangle(std::uint32_t primitive, const InstanceTransform* instance) const;
    void set_instance_offset(std::uint32_t primitive, const InstanceTransform& instance, SurfacePoint& x) const;
    bool shading_normal(std::uint32_t primitive, const InstanceTransform* instance, const Vec2& b, Vec3& n) const;
    Vec2 uv(std::uint32_t primitive, const Vec2& b) const;
    void set_frame(const ShapeHit& hit, SurfacePoint& x) const;
    void set_tangents(const Triangle& f, std::uint32_t primitive, const Vec3& n, SurfacePoint& x) const;

    std::shared_ptr<const Mesh> mesh_;
    std::vector<Vec3f> own_positions_, own_normals_;
    std::vector<std::array<std::uint32_t, 3>> own_triangles_;
    std::span<const Vec3f> positions_, normals_;  // normals_ empty: face normals
    std::span<const Vec2f> uvs_;
    std::span<const std::array<std::uint32_t, 3>> triangles_;
    std::vector<Plane> planes_;
    // For sampling:
    std::vector<Corner> corners_;
    std::vector<double> area_cdf_;      // entry i: area of triangles 0 to i
    std::uint32_t last_with_area_ = 0;  // the last triangle that has any
    double area_ = 0;
};

// Throws std::invalid_argument for a mesh without triangles, with indices out of range or values that are not finite.
void check_mesh(const Mesh& mesh);

}  // namespace keyhole
