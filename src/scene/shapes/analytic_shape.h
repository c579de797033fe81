// Shapes given by an equation: a canonical shape (unit sphere, unit disk, unit cylinder) under an affine transform.
// Everything is computed in double precision, in the canonical space, with directions that are not normalised, so that
// distances along a ray are the same in both spaces.
#pragma once

#include <utility>

#include "scene/shape.h"

namespace keyhole {

class AnalyticShape : public Shape {
  public:
    // The nearest distance in (tnear, tfar) at which the ray meets the shape; infinity if there is none.
    double nearest(const Vec3& o, const Vec3& d, double tnear, double tfar) const;
    double fill(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const override;
    ShapeSample sample(double u_primitive, const Vec2& u) const override;
    EmitterNumbers invert_sample(std::uint32_t primitive, const Vec3& p, const InverseNumbers& v) const override;
    double area() const override { return area_; }

    // Moves the shape by a vector, before it is used.
    void translate(const Vec3& by) { set_transform(Eigen::Translation3d(by) * to_world_, area_); }

    // The box around the shape, of its own space (the group's if it belongs to one).
    std::pair<Vec3, Vec3> bounds() const;

  protected:
    struct Point {
        Vec3 p, n;  // n is the outward normal, not normalised
    };
    struct Parameters {
        Vec2 uv;
        Vec3 dpdu, dpdv;
    };
    // Where a line meets the unbounded surface (sphere, plane, infinite cylinder): increasing distances. If it misses,
    // the distance of the closest approach, with hit = false.
    struct Roots {
        double t[2] = {0, 0};
        int count = 0;
        bool hit = false;
    };

    virtual Roots roots(const Vec3& o, const Vec3& d) const = 0;
    virtual bool contains(const Vec3& p) const = 0;          // p on the unbounded surface: is it on the shape?
    virtual Point project(const Vec3& p) const = 0;          // the surface point nearest to p
    virtual Parameters parameters(const Vec3& p) const = 0;  // p on the surface
    virtual Vec3 sample_local(const Vec2& u) const = 0;      // uniform in area under the transforms allowed
    virtual Vec2 invert_local(const Vec3& p) const = 0;      // its inverse
    virtual std::pair<Vec3, Vec3> local_bounds() const = 0;

    // Solutions of a t^2 - 2 b t + c = 0 given its discriminant b^2 - a c, without cancellation.
    static Roots solve(double a, double b, double c, double discriminant);

    void set_transform(const Affine& to_world, double area);

    Affine to_world_ = Affine::Identity(), to_local_ = Affine::Identity();

  private:
    double fill_under(const Ray& ray, const ShapeHit& hit, const Affine& to_world, const Affine& to_local,
                      SurfacePoint& x) const;

    double area_ = 0;
};

// Largest relative difference of its columns' lengths and of their cosines that counts as none: matrices in scene
// files often carry six digits.
inline constexpr double similarity_tolerance = 1e-4;

// The scale of a transform that is rotation, reflection and uniform scale. Throws std::invalid_argument for any other,
// and for one that is singular or not finite; `shape` is named in the message.
double uniform_scale(const Affine& transform, const char* shape);
// Throws std::invalid_argument for a singular transform or one that is not finite.
void check_invertible(const Affine& transform, const char* shape);

}  // namespace keyhole
