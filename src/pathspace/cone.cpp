#include "pathspace/cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace keyhole {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The space between the cone's planes, from the apex: t1 L <= w.p, and n.(p - t2 L w) <= 0 with n towards the far end.
struct Slab {
    Vec3 w, n;
    double near, far;

    Slab(const ConeEdge& edge, const ConeSettings& settings)
        : w(edge.axis),
          n(edge.far_normal.dot(edge.axis) < 0 ? Vec3(-edge.far_normal) : edge.far_normal),
          near(settings.t1 * edge.length),
          far(settings.t2 * edge.length * n.dot(edge.axis)) {}
    double before_near(const Vec3& p) const { return near - w.dot(p); }  // <= 0 inside
    double behind_far(const Vec3& p) const { return n.dot(p) - far; }    // <= 0 inside
};

// The smallest angle to an axis, by the largest cosine, and only then as an angle: with the tangent, which is accurate
// at small angles.
class LeastAngle {
  public:
    explicit LeastAngle(const Vec3& axis) : w_(axis) {}
    // Of the segment p + s e, s in [0, 1]: at its ends, or where the derivative of the cosine is zero.
    void segment(const Vec3& p, const Vec3& e) {
        point(p);
        point(p + e);
        const double a = w_.dot(p), b = w_.dot(e), c = p.squaredNorm(), d = p.dot(e), f = e.squaredNorm();
        const double s = (a * d - b * c) / (b * d - a * f);
        if (s > 0 && s < 1) point(p + s * e);
    }
    void point(const Vec3& p) {
        const double along = w_.dot(p);
        if (!(along > 0)) return;
        tan2_ = std::min(tan2_, std::max(0.0, (p - along * w_).squaredNorm() / (along * along)));
    }
    double angle() const { return tan2_ < infinity ? std::atan(std::sqrt(tan2_)) : infinity; }

  private:
    const Vec3& w_;
    double tan2_ = infinity;
};

// Of a convex body by its edges, cut by the slab: the smallest angle lies on an edge of what is left, so on a part of
// an edge or on one of the chords between the points in which edges meet a plane.
class Outline {
  public:
    explicit Outline(const Slab& slab) : slab_(slab), least_(slab.w) {}

    void edge(const Vec3& p, const Vec3& q) {
        double begin = 0, end = 1;
        cut(slab_.before_near(p), slab_.before_near(q), p, q, near_points_, near_count_, begin, end);
        cut(slab_.behind_far(p), slab_.behind_far(q), p, q, far_points_, far_count_, begin, end);
        if (begin <= end) least_.segment(p + begin * (q - p), (end - begin) * (q - p));
    }
    double angle() {
        chords(near_points_, near_count_, [&](const Vec3& p) { return slab_.behind_far(p); });
        chords(far_points_, far_count_, [&](const Vec3& p) { return slab_.before_near(p); });
        return least_.angle();
    }

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

    const Slab& slab_;
    LeastAngle least_;
    Points near_points_, far_points_;
    std::size_t near_count_ = 0, far_count_ = 0;
};

Vec3 corner(const Vec3& lower, const Vec3& upper, int i) {
    return {i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z()};
}

// Whether the axis between the planes meets the box.
bool meets(const ConeEdge& edge, const ConeSettings& settings, const BoxHierarchy::Node& node) {
    double begin = settings.t1 * edge.length, end = settings.t2 * edge.length;
    for (int i = 0; i < 3; ++i) {
        const double o = edge.apex[i], d = edge.axis[i], lower = double(node.lower[i]), upper = double(node.upper[i]);
        if (d == 0) {
            if (o < lower || o > upper) return false;
            continue;
        }
        const double a = (lower - o) / d, b = (upper - o) / d;
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end;
}

bool wider(double a, double b) { return a > b; }

}  // namespace

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const BoxHierarchy::Triangle& triangle) {
    const Slab slab(edge, settings);
    Outline outline(slab);
    const std::array<Vec3, 3> p = {triangle[0] - edge.apex, triangle[1] - edge.apex, triangle[2] - edge.apex};
    for (std::size_t i = 0; i < 3; ++i) outline.edge(p[i], p[(i + 1) % 3]);
    return outline.angle();
}

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const Vec3& lower, const Vec3& upper) {
    const Slab slab(edge, settings);
    Outline outline(slab);
    const Vec3 l = lower - edge.apex, u = upper - edge.apex;
    for (int i = 0; i < 8; ++i)
        for (int bit = 1; bit < 8; bit <<= 1)
            if (!(i & bit)) outline.edge(corner(l, u, i), corner(l, u, i | bit));
    return outline.angle();
}

ConeFinder::ConeFinder(const BoxHierarchy& boxes, const ConeSettings& settings) : boxes_(&boxes), settings_(settings) {
    stack_.reserve(256);
    queue_.reserve(1024);
}

// Visits the boxes that the edge does not meet, of parents that it meets, and leaves that it meets.
template <class Visit>
void ConeFinder::initial_cut(const ConeEdge& edge, const Visit& visit) {
    if (boxes_->empty()) return;
    stack_.assign(1, &boxes_->root());
    while (!stack_.empty()) {
        const BoxHierarchy::Node& node = *stack_.back();
        stack_.pop_back();
        const bool met = meets(edge, settings_, node);
        if (!met || node.leaf) {
            visit(node, met);
            continue;
        }
        stack_.push_back(&boxes_->child(node, 0));
        stack_.push_back(&boxes_->child(node, 1));
    }
}

double ConeFinder::fast(const ConeEdge& edge) {
    const Slab slab(edge, settings_);
    LeastAngle least(slab.w);
    initial_cut(edge, [&](const BoxHierarchy::Node& node, bool met) {
        if (met) return;
        const Vec3 lower = node.lower.cast<double>() - edge.apex, upper = node.upper.cast<double>() - edge.apex;
        for (int i = 0; i < 8; ++i) {
            const Vec3 p = corner(lower, upper, i);
            if (slab.before_near(p) <= 0 && slab.behind_far(p) <= 0) least.point(p);
        }
    });
    return least.angle();
}

void ConeFinder::push(const ConeEdge& edge, const BoxHierarchy::Node& node) {
    const double angle = node.leaf ? least_angle(edge, settings_, boxes_->triangle(node))
                                   : least_angle(edge, settings_, node.lower.cast<double>(), node.upper.cast<double>());
    if (!(angle < settings_.tau_max)) return;
    queue_.push_back({angle, &node});
    std::push_heap(queue_.begin(), queue_.end(),
                   [](const Entry& a, const Entry& b) { return wider(a.angle, b.angle); });
}

double ConeFinder::refined(const ConeEdge& edge, int boxes) {
    queue_.clear();
    initial_cut(edge, [&](const BoxHierarchy::Node& node, bool) { push(edge, node); });
    for (int opened = 0; !queue_.empty(); ++opened) {
        const Entry narrowest = queue_.front();
        if (narrowest.node->leaf || opened == boxes) return narrowest.angle;
        std::pop_heap(queue_.begin(), queue_.end(),
                      [](const Entry& a, const Entry& b) { return wider(a.angle, b.angle); });
        queue_.pop_back();
        for (int i = 0; i < 2; ++i) push(edge, boxes_->child(*narrowest.node, i));
    }
    return infinity;
}

double ConeFinder::operator()(const ConeEdge& edge) {
    const double angle = settings_.estimator == ConeEstimator::fast      ? fast(edge)
                         : settings_.estimator == ConeEstimator::bvh_cut ? refined(edge, settings_.boxes)
                                                                         : refined(edge, -1);
    return std::clamp(angle, settings_.tau_min, settings_.tau_max);
}

}  // namespace keyhole
