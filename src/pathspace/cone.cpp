#include "pathspace/cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace keyhole {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t all_boxes = std::numeric_limits<std::size_t>::max();

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
    double angle() const { return tan2_ < infinity ? std::atan(std::sqrt(tan2_)) : infinity; }

  private:
    const Vec3& w_;
    Vec3 point_{0, 0, 0};
    double tan2_ = infinity;
};

// Of a convex body by its edges, cut by the slab: the smallest angle lies on an edge of what is left, so on a part of
// an edge or on one of the chords between the points in which edges meet a plane.
class Outline {
  public:
    explicit Outline(const Slab& slab) : slab_(slab), least_(slab.w) {}

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
    double angle() {
        chords(near_points_, near_count_, [&](const Vec3& p) { return slab_.behind_far(p); });
        chords(far_points_, far_count_, [&](const Vec3& p) { return slab_.before_near(p); });
        return least_.angle();
    }

    // After angle(), from the apex.
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

    const Slab& slab_;
    LeastAngle least_;
    Points near_points_, far_points_;
    std::size_t near_count_ = 0, far_count_ = 0;
};

Vec3 corner(const Vec3& lower, const Vec3& upper, int i) {
    return {i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z()};
}

void add_triangle(Outline& outline, const ConeEdge& edge, const BoxHierarchy::Triangle& triangle) {
    const std::array<Outline::Corner, 3> corners = {outline.corner(triangle[0] - edge.apex),
                                                    outline.corner(triangle[1] - edge.apex),
                                                    outline.corner(triangle[2] - edge.apex)};
    for (std::size_t i = 0; i < 3; ++i) outline.edge(corners[i], corners[(i + 1) % 3]);
}

}  // namespace

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const BoxHierarchy::Triangle& triangle) {
    const Slab slab(edge, settings);
    Outline outline(slab);
    add_triangle(outline, edge, triangle);
    return outline.angle();
}

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const Vec3& lower, const Vec3& upper) {
    const Slab slab(edge, settings);
    Outline outline(slab);
    const Vec3 l = lower - edge.apex, u = upper - edge.apex;
    std::array<Outline::Corner, 8> corners;
    for (int i = 0; i < 8; ++i) corners[static_cast<std::size_t>(i)] = outline.corner(corner(l, u, i));
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t bit = 1; bit < 8; bit <<= 1)
            if (!(i & bit)) outline.edge(corners[i], corners[i | bit]);
    return outline.angle();
}

ConeFinder::ConeFinder(const BoxHierarchy& boxes, const ConeSettings& settings) : boxes_(&boxes), settings_(settings) {
    stack_.reserve(256);
    queue_.reserve(1024);
}

// What is computed once for an edge.
struct ConeFinder::Query {
    const ConeEdge& edge;
    const ConeSettings& settings;
    Slab slab;
    Vec3 inverse;  // of the axis, by coordinate
    double begin, end, tan_max;
    double steep;     // cosine to a plane's normal that the cone of tau_max does not reach the plane from
    double farthest;  // along the axis, of points before the far plane and in the cone of tau_max

    Query(const ConeEdge& e, const ConeSettings& s)
        : edge(e),
          settings(s),
          slab(e, s),
          inverse(e.axis.cwiseInverse()),
          begin(s.t1 * e.length),
          end(s.t2 * e.length),
          tan_max(std::tan(s.tau_max)),
          steep(std::sin(std::min(s.tau_max + 1.001e-3, 0.5 * pi))) {
        const double towards = slab.n.dot(slab.w);
        const double reach = towards - tan_max * std::sqrt(std::max(0.0, 1 - towards * towards));
        farthest = reach > 0 ? slab.far / reach : infinity;
    }

    // Whether the axis between the planes meets the box. (Where it lies in the plane of a side, NaN counts as met.)
    bool meets(const BoxHierarchy::Node& node) const {
        const Vec3 a = (node.lower.cast<double>() - edge.apex).cwiseProduct(inverse);
        const Vec3 b = (node.upper.cast<double>() - edge.apex).cwiseProduct(inverse);
        const double from = std::max(begin, a.cwiseMin(b).maxCoeff()), to = std::min(end, a.cwiseMax(b).minCoeff());
        return !(from > to);
    }

    // A lower bound of the angle; infinite where the box is outside of the slab or of the cone of the half-angle
    // tau_max.
    double bound(const BoxHierarchy::Node& node) const {
        const Vec3 lower = node.lower.cast<double>() - edge.apex, upper = node.upper.cast<double>() - edge.apex;
        // Behind a plane through the apex that the axis leaves at a larger angle, as the surface is that it starts on:
        // of the box, less than a thousandth of the distance to the near plane may be before it.
        for (int i = 0; i < 3; ++i)
            if ((lower[i] >= -1e-3 * begin && slab.w[i] < -steep) || (upper[i] <= 1e-3 * begin && slab.w[i] > steep))
                return infinity;
        const Vec3 c = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
        const auto extent = [&](const Vec3& direction) { return half.dot(direction.cwiseAbs()); };
        const double along = slab.w.dot(c), along_most = along + extent(slab.w);
        if (along_most < slab.near || slab.n.dot(c) - extent(slab.n) > slab.far) return infinity;
        // Farther from the axis than its nearest side, and nearer along it than its far end or the slab's.
        const Vec3 across = c - along * slab.w;
        const double distance = across.norm();
        if (!(distance > 0)) return 0;
        const double gap = distance - extent(across / distance), length = std::min(along_most, farthest);
        if (gap >= tan_max * length) return infinity;
        return gap > 0 ? std::atan(gap / length) * (1 - 1e-12) : 0;
    }
    double angle(const BoxHierarchy& boxes, const BoxHierarchy::Node& node) const {
        return node.leaf ? least_angle(edge, settings, boxes.triangle(node))
                         : least_angle(edge, settings, node.lower.cast<double>(), node.upper.cast<double>());
    }
};

// Visits the boxes that the edge does not meet, of parents that it meets, and leaves that it meets.
template <class Visit>
void ConeFinder::initial_cut(const Query& query, const Visit& visit) {
    if (boxes_->empty()) return;
    stack_.assign(1, &boxes_->root());
    while (!stack_.empty()) {
        const BoxHierarchy::Node& node = *stack_.back();
        stack_.pop_back();
        const bool met = query.meets(node);
        if (!met || node.leaf) {
            visit(node, met);
            continue;
        }
        stack_.push_back(&boxes_->child(node, 0));
        stack_.push_back(&boxes_->child(node, 1));
    }
}

double ConeFinder::fast(const Query& query) {
    LeastAngle least(query.slab.w);
    initial_cut(query, [&](const BoxHierarchy::Node& node, bool met) {
        if (met || query.bound(node) == infinity) return;
        const Vec3 lower = node.lower.cast<double>() - query.edge.apex,
                   upper = node.upper.cast<double>() - query.edge.apex;
        for (int i = 0; i < 8; ++i) {
            const Vec3 p = corner(lower, upper, i);
            if (query.slab.before_near(p) <= 0 && query.slab.behind_far(p) <= 0) least.point(p);
        }
    });
    return least.angle();
}

void ConeFinder::push(const Entry& entry) {
    if (!(entry.angle < settings_.tau_max)) return;
    queue_.push_back(entry);
    std::push_heap(queue_.begin(), queue_.end(), [](const Entry& a, const Entry& b) { return a.angle > b.angle; });
}

ConeFinder::Entry ConeFinder::pop() {
    std::pop_heap(queue_.begin(), queue_.end(), [](const Entry& a, const Entry& b) { return a.angle > b.angle; });
    const Entry entry = queue_.back();
    queue_.pop_back();
    return entry;
}

// Best first. Angles are computed only of what comes first by its bound.
ConeFinder::Entry ConeFinder::refined(const Query& query, std::size_t boxes) {
    queue_.clear();
    const auto push_bound = [&](const BoxHierarchy::Node& node) { push({query.bound(node), &node, false}); };
    initial_cut(query, [&](const BoxHierarchy::Node& node, bool) { push_bound(node); });
    while (!queue_.empty()) {
        const Entry narrowest = pop();
        if (!narrowest.known) {
            push({query.angle(*boxes_, *narrowest.node), narrowest.node, true});
            continue;
        }
        // The narrowest itself is one of them.
        if (narrowest.node->leaf || queue_.size() + 1 >= boxes) return narrowest;
        for (int i = 0; i < 2; ++i) push_bound(boxes_->child(*narrowest.node, i));
    }
    return {infinity, nullptr, true};
}

double ConeFinder::operator()(const ConeEdge& edge) {
    const Query query(edge, settings_);
    const double angle = settings_.estimator == ConeEstimator::fast ? fast(query)
                         : settings_.estimator == ConeEstimator::bvh_cut
                             ? refined(query, static_cast<std::size_t>(settings_.boxes)).angle
                             : refined(query, all_boxes).angle;
    return std::clamp(angle, settings_.tau_min, settings_.tau_max);
}

std::optional<Vec3> ConeFinder::contact(const ConeEdge& edge) {
    const Entry nearest = refined(Query(edge, settings_), all_boxes);
    if (!nearest.node) return std::nullopt;
    const Slab slab(edge, settings_);
    Outline outline(slab);
    add_triangle(outline, edge, boxes_->triangle(*nearest.node));
    outline.angle();
    return edge.apex + outline.where();
}

}  // namespace keyhole
