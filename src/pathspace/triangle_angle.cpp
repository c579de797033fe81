#include "pathspace/triangle_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The smallest angle to an axis, by its tangent, which is accurate at small angles.
class LeastAngle {
  public:
    explicit LeastAngle(const Vec3& axis) : w_(axis) {}
    // Of the segment p + s e, s in [0, 1]: at its ends, or where the derivative of the cosine is zero.
    void segment(const Vec3& p, const Vec3& e) {
        point(p);
        point(p + e);
        inside(p, e, w_.dot(p), w_.dot(e), p.squaredNorm(), p.dot(e), e.squaredNorm());
    }
    // The same without the ends, by w.p, w.e, p.p, p.e and e.e.
    void inside(const Vec3& p, const Vec3& e, double wp, double we, double pp, double pe, double ee) {
        const double s = (wp * pe - we * pp) / (we * pe - wp * ee);
        if (s > 0 && s < 1) point(p + s * e);
    }
    void point(const Vec3& p) {
        const double along = w_.dot(p);
        if (!(along > 0)) return;
        const double tan2 = (p - along * w_).squaredNorm() / (along * along);
        if (!(tan2 < tan2_)) return;
        tan2_ = tan2;
        point_ = p;
    }
    const Vec3& where() const { return point_; }
    double tangent() const { return std::sqrt(tan2_); }

  private:
    const Vec3& w_;
    Vec3 point_{0, 0, 0};
    double tan2_ = infinity;
};

// Of a convex body by its edges, cut by the slab: the smallest angle lies on an edge of what is left, so on a part of
// an edge or on one of the chords between the points in which edges meet a plane.
class Outline {
  public:
    explicit Outline(const ConeSlab& slab) : slab_(slab), least_(slab.w) {}

    // A corner, from the apex, with what its edges share.
    struct Corner {
        Vec3 p;
        double along, square, before_near, behind_far;
        bool inside() const { return before_near <= 0 && behind_far <= 0; }
    };
    Corner corner(const Vec3& p) {
        const double along = slab_.w.dot(p);
        const Corner c{p, along, p.squaredNorm(), slab_.near - along, slab_.behind_far(p)};
        if (c.inside()) least_.point(p);
        return c;
    }
    void edge(const Corner& p, const Corner& q) {
        const Vec3 e = q.p - p.p;
        if (p.inside() && q.inside()) {
            const double pq = p.p.dot(q.p);
            least_.inside(p.p, e, p.along, q.along - p.along, p.square, pq - p.square, p.square - 2 * pq + q.square);
            return;
        }
        double begin = 0, end = 1;
        cut(p.before_near, q.before_near, p.p, q.p, near_points_, near_count_, begin, end);
        cut(p.behind_far, q.behind_far, p.p, q.p, far_points_, far_count_, begin, end);
        if (begin <= end) least_.segment(p.p + begin * e, (end - begin) * e);
    }
    double tangent() {
        chords(near_points_, near_count_, [&](const Vec3& p) { return slab_.behind_far(p); });
        chords(far_points_, far_count_, [&](const Vec3& p) { return slab_.before_near(p); });
        return least_.tangent();
    }

    // After tangent(), from the apex.
    const Vec3& where() const { return least_.where(); }

  private:
    static constexpr std::size_t most = 12;
    using Points = std::array<Vec3, most>;

    // Keeps the part of an edge with a signed distance of at most zero, and notes where it passes the plane.
    static void cut(double at_p, double at_q, const Vec3& p, const Vec3& q, Points& points, std::size_t& count,
                    double& begin, double& end) {
        if (at_p <= 0 && at_q <= 0) return;
        if (at_p > 0 && at_q > 0) {
            begin = 2;
            return;
        }
        const double s = at_p / (at_p - at_q);
        if (count < most) points[count++] = p + s * (q - p);
        if (at_p > 0)
            begin = std::max(begin, s);
        else
            end = std::min(end, s);
    }
    // Chords of one plane, cut by the other.
    template <class Distance>
    void chords(const Points& points, std::size_t count, const Distance& distance) {
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec3 &p = points[i], &q = points[j];
                const double at_p = distance(p), at_q = distance(q);
                if (at_p > 0 && at_q > 0) continue;
                double begin = 0, end = 1;
                if (at_p > 0) begin = at_p / (at_p - at_q);
                if (at_q > 0) end = at_p / (at_p - at_q);
                least_.segment(p + begin * (q - p), (end - begin) * (q - p));
            }
    }

    const ConeSlab& slab_;
    LeastAngle least_;
    Points near_points_, far_points_;
    std::size_t near_count_ = 0, far_count_ = 0;
};

void add_triangle(Outline& outline, const Vec3& apex, const BoxHierarchy::Triangle& triangle) {
    const std::array<Outline::Corner, 3> corners = {
        outline.corner(triangle[0] - apex), outline.corner(triangle[1] - apex), outline.corner(triangle[2] - apex)};
    for (std::size_t i = 0; i < 3; ++i) outline.edge(corners[i], corners[(i + 1) % 3]);
}

// Of four segments p + s e, s in [0, 1], all of them between the planes, the smallest squared tangent. Angles along a
// line have one extremum, so it is at an end or there.
double least_square(const ConeSlab& slab, const std::array<Double4, 3>& p, const std::array<Double4, 3>& e) {
    Double4 along = {}, step = {}, qq = {}, qr = {}, rr = {};
    for (int i = 0; i < 3; ++i) {
        along += slab.w[i] * p[static_cast<std::size_t>(i)];
        step += slab.w[i] * e[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < 3; ++i) {  // across the axis
        const Double4 q = p[static_cast<std::size_t>(i)] - along * slab.w[i];
        const Double4 r = e[static_cast<std::size_t>(i)] - step * slab.w[i];
        qq += q * q;
        qr += q * r;
        rr += r * r;
    }
    const Double4 s = (step * qq - qr * along) / (rr * along - step * qr);
    const Double4 inside = s > 0 ? (s < 1 ? s : Double4{} + 1) : Double4{};
    const auto square = [&](const Double4& t) {
        const Double4 across = qq + t * (2 * qr + t * rr), w = along + t * step;
        return (across > 0 ? across : Double4{}) / (w * w);
    };
    const Double4 at_begin = square(Double4{}), at_end = square(Double4{} + 1), between = square(inside);
    const Double4 ends = at_begin < at_end ? at_begin : at_end, all = ends < between ? ends : between;
    return std::min(std::min(all[0], all[1]), std::min(all[2], all[3]));
}

}  // namespace

double least_tangent(const ConeSlab& slab, const Vec3& apex, const BoxHierarchy::Triangle& triangle) {
    const Vec3 a = triangle[0] - apex, b = triangle[1] - apex, c = triangle[2] - apex;
    if (slab.holds(a) && slab.holds(b) && slab.holds(c)) {
        std::array<Double4, 3> p, e;
        for (int i = 0; i < 3; ++i) {
            p[static_cast<std::size_t>(i)] = Double4{a[i], b[i], c[i], c[i]};
            e[static_cast<std::size_t>(i)] = Double4{b[i] - a[i], c[i] - b[i], a[i] - c[i], 0};
        }
        return std::sqrt(least_square(slab, p, e));
    }
    Outline outline(slab);
    add_triangle(outline, apex, triangle);
    return outline.tangent();
}

Vec3 nearest_to_axis(const ConeSlab& slab, const Vec3& apex, const BoxHierarchy::Triangle& triangle) {
    Outline outline(slab);
    add_triangle(outline, apex, triangle);
    outline.tangent();
    return apex + outline.where();
}

}  // namespace keyhole
