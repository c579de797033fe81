#include "scene/shapes/analytic_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "scene/instance.h"
#include "scene/shapes/shading_frame.h"

namespace keyhole {
namespace {

// Error of p as computed in double precision and transformed back and forth, with a wide margin: still nothing beside
// a float's. Queries are decided in double precision, so it need not cover their rounding to float.
template <class Point>
void set_offset(const Vec3& p_local, const Affine& to_world, const Affine& to_local, Point& x) {
    const double local = p_local.lpNorm<1>() + (to_local.linear().cwiseAbs() * x.p.cwiseAbs()).sum() +
                         to_local.translation().lpNorm<1>();
    const double scale = to_world.linear().cwiseAbs().sum();
    x.offset = static_cast<float>(0x1p-46 * (x.p.template lpNorm<1>() + scale * local));
    x.offset_per_length = static_cast<float>(0x1p-46 * (1 + scale * to_local.linear().cwiseAbs().sum()));
}

}  // namespace

AnalyticShape::Roots AnalyticShape::solve(double a, double b, double c, double discriminant) {
    if (!(discriminant >= 0)) return {{b / a, b / a}, 1, false};
    const double q = b + std::copysign(std::sqrt(discriminant), b);
    if (q == 0) return {{0, 0}, 1, true};
    const double t0 = c / q, t1 = q / a;
    return {{std::min(t0, t1), std::max(t0, t1)}, 2, true};
}

void AnalyticShape::set_transform(const Affine& to_world, double area) {
    to_world_ = to_world;
    to_local_ = to_world.inverse();
    area_ = area;
}

double AnalyticShape::nearest(const Vec3& o, const Vec3& d, double tnear, double tfar) const {
    const Vec3 o_local = to_local_ * o, d_local = to_local_.linear() * d;
    const Roots r = roots(o_local, d_local);
    if (r.hit) {
        for (int i = 0; i < r.count; ++i) {
            if (r.t[i] > tnear && r.t[i] < tfar && contains(o_local + r.t[i] * d_local)) return r.t[i];
        }
    }
    return std::numeric_limits<double>::infinity();
}

double AnalyticShape::fill(const Ray& ray, const ShapeHit& hit, SurfacePoint& x) const {
    if (hit.instance)
        return fill_under(ray, hit, hit.instance->to_world * to_world_, to_local_ * hit.instance->to_local, x);
    return fill_under(ray, hit, to_world_, to_local_, x);
}

double AnalyticShape::fill_under(const Ray& ray, const ShapeHit& hit, const Affine& to_world, const Affine& to_local,
                                 SurfacePoint& x) const {
    const Vec3 o = to_local * ray.o, d = to_local.linear() * ray.d;
    const Roots r = roots(o, d);
    const bool second = r.count == 2 && std::abs(r.t[1] - hit.t) < std::abs(r.t[0] - hit.t);
    const double t = r.count > 0 ? r.t[second] : hit.t;

    const Point local = project(o + t * d);
    x.p = to_world * local.p;
    x.ng = (to_local.linear().transpose() * local.n).normalized();
    if (flip_normals) x.ng = -x.ng;
    set_offset(local.p, to_world, to_local, x);
    if (!needs_uv && !needs_tangents) {
        x.frame = Frame::from_normal(x.ng);
        return t;
    }
    const Parameters at = parameters(local.p);
    x.uv = at.uv;
    set_shading_frame(x, x.ng, needs_tangents, to_world.linear() * at.dpdu, to_world.linear() * at.dpdv);
    return t;
}

ShapeSample AnalyticShape::sample(double /*u_primitive*/, const Vec2& u) const {
    const Point local = project(sample_local(u));
    const Vec3 p = to_world_ * local.p;
    const Vec3 n = (to_local_.linear().transpose() * local.n).normalized();
    ShapeSample s{p, flip_normals ? Vec3(-n) : n, needs_uv ? parameters(local.p).uv : Vec2(0, 0)};
    set_offset(local.p, to_world_, to_local_, s);
    return s;
}

EmitterNumbers AnalyticShape::invert_sample(std::uint32_t /*primitive*/, const Vec3& p, const InverseNumbers& v) const {
    return {v.place, invert_local(project(to_local_ * p).p)};
}

std::pair<Vec3, Vec3> AnalyticShape::bounds() const {
    const auto [lower, upper] = local_bounds();
    const Vec3 center = to_world_ * Vec3((lower + upper) / 2);
    const Vec3 extent = to_world_.linear().cwiseAbs() * ((upper - lower) / 2);
    return {center - extent, center + extent};
}

void check_invertible(const Affine& transform, const char* shape) {
    const Eigen::Matrix3d m = transform.linear();
    if (!transform.matrix().allFinite()) {
        throw std::invalid_argument(std::string(shape) + ": the transform is not finite");
    }
    // Relative to the columns' lengths, so that a uniform scale of 1e-30 is as good as any.
    const double size = m.col(0).norm() * m.col(1).norm() * m.col(2).norm();
    if (!(std::abs(m.determinant()) > 1e-12 * size)) {
        throw std::invalid_argument(std::string(shape) + ": the transform is singular");
    }
}

double uniform_scale(const Affine& transform, const char* shape) {
    check_invertible(transform, shape);
    const Eigen::Matrix3d m = transform.linear();
    const double scale = std::cbrt(std::abs(m.determinant()));
    const Eigen::Matrix3d deviation = m.transpose() * m / (scale * scale) - Eigen::Matrix3d::Identity();
    if (deviation.cwiseAbs().maxCoeff() > 2 * similarity_tolerance) {
        throw std::invalid_argument(std::string(shape) + ": the transform shears or scales non-uniformly");
    }
    return scale;
}

}  // namespace keyhole
