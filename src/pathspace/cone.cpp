#include "pathspace/cone.h"

#include <algorithm>
#include <array>
#include <bit>
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
    bool holds(const Vec3& p) const { return before_near(p) <= 0 && behind_far(p) <= 0; }
};

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

    const Slab& slab_;
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
double least_square(const Slab& slab, const std::array<Double4, 3>& p, const std::array<Double4, 3>& e) {
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

double least_tangent(const Slab& slab, const Vec3& apex, const BoxHierarchy::Triangle& triangle) {
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

double to_angle(double tangent) { return tangent < infinity ? std::atan(tangent) : infinity; }

template <class Body>
void for_each_bit(unsigned bits, const Body& body) {
    for (; bits; bits &= bits - 1) body(std::countr_zero(bits));
}

}  // namespace

double least_angle(const ConeEdge& edge, const ConeSettings& settings, const BoxHierarchy::Triangle& triangle) {
    return to_angle(least_tangent(Slab(edge, settings), edge.apex, triangle));
}

ConeFinder::ConeFinder(const BoxHierarchy& boxes, const ConeSettings& settings)
    : boxes_(&boxes), settings_(settings), tan_tau_(std::tan(settings.tau_max)) {
    stack_.reserve(256);
    queue_.reserve(1024);
}

// What is computed once for an edge. Eight boxes are looked at at once, in single precision relative to the apex; what
// is decided so allows for its rounding, so that no box is left out and no bound too large.
struct ConeFinder::Query {
    const ConeEdge& edge;
    Slab slab;
    float begin, end, far, tan_max;
    float farthest;  // along the axis, of points before the far plane and in the cone of tau_max
    std::array<float, 3> w, n, inverse;
    std::array<float, 3> lowest, highest;  // corners of a box about the cone of tau_max between the planes

    Query(const ConeEdge& e, const ConeSettings& s, double tan_tau) : edge(e), slab(e, s) {
        begin = static_cast<float>(s.t1 * e.length * (1 - slack));
        end = static_cast<float>(s.t2 * e.length * (1 + slack));
        far = static_cast<float>(slab.far);
        tan_max = static_cast<float>(tan_tau * (1 + slack));
        const double towards = slab.n.dot(slab.w);
        const double reach = towards - tan_tau * std::sqrt(std::max(0.0, 1 - towards * towards));
        farthest = reach > 0 ? static_cast<float>(slab.far / reach * (1 + slack)) : std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < 3; ++i) {
            const double along = slab.w[static_cast<int>(i)],
                         across = tan_tau * std::sqrt(1 - std::min(1.0, along * along));
            w[i] = static_cast<float>(along);
            n[i] = static_cast<float>(slab.n[static_cast<int>(i)]);
            inverse[i] = static_cast<float>(1 / (std::abs(along) > 1e-20 ? along : 1e-20));
            lowest[i] = (along > across ? begin : farthest) * static_cast<float>(along - across);
            highest[i] = (along < -across ? begin : farthest) * static_cast<float>(along + across);
        }
    }

    // Of the boxes of a node. Those beside are neither met nor out of reach, and seen under angles of the tangents
    // given or larger ones.
    struct View {
        std::array<Float8, 3> lower, upper;  // from the apex
        Float8 tangents;
        unsigned met, beside;

        double bound(int lane) const { return met >> lane & 1 ? 0 : tangents[lane]; }
    };
    View view(const BoxHierarchy::Node& node) const {
        View v;
        Float8 from = broadcast(begin), to = broadcast(end), along{}, on_normal{}, reach{}, reach_normal{}, square{};
        Int32x8 out{};
        std::array<Float8, 3> centre, half;
        for (std::size_t i = 0; i < 3; ++i) {
            v.lower[i] = relative(node.lower[i], i);
            v.upper[i] = relative(node.upper[i], i);
            const Float8 a = v.lower[i] * inverse[i], b = v.upper[i] * inverse[i];
            from = greatest(from, least(a, b));
            to = least(to, greatest(a, b));
            out |= (v.upper[i] < lowest[i]) | (v.lower[i] > highest[i]);
            centre[i] = 0.5f * (v.lower[i] + v.upper[i]);
            half[i] = 0.5f * (v.upper[i] - v.lower[i]);
            along += w[i] * centre[i];
            on_normal += n[i] * centre[i];
            reach += std::abs(w[i]) * half[i];
            reach_normal += std::abs(n[i]) * half[i];
        }
        // Farther from the axis than its nearest side, and nearer along it than its far end or the slab's. The side is
        // towards the point of the box nearest to the axis at the box's middle.
        const Float8 middle = least(greatest(along, broadcast(begin)), broadcast(end));
        Float8 at{}, offset{}, support{};
        std::array<Float8, 3> side;
        for (std::size_t i = 0; i < 3; ++i) {
            side[i] = least(greatest(middle * w[i], v.lower[i]), v.upper[i]);
            at += w[i] * side[i];
        }
        Float8 rounded{};
        for (std::size_t i = 0; i < 3; ++i) {
            side[i] -= at * w[i];
            const Float8 across = centre[i] - along * w[i], size = magnitude(side[i]);
            square += side[i] * side[i];
            offset += side[i] * across;
            support += size * half[i];
            rounded += size * (magnitude(across) + half[i]);
        }
        const Float8 distance = square_root(square), most = along + reach;
        const Float8 margin = slack * (rounded / distance + magnitude(along) + reach);
        const Float8 gap = (offset - support) / distance - margin, length = least(most + margin, broadcast(farthest));
        out |= (most + margin < begin) | (on_normal - (1 + slack) * reach_normal - margin > far) |
               (gap > tan_max * length);
        v.tangents = gap > 0 ? gap / length * (1 - slack) : Float8{};
        v.met = node.boxes & mask(from <= to * (1 + slack));
        v.beside = node.boxes & ~(v.met | mask(out));
        return v;
    }

    // The squared tangents of the nearest corners between the planes, of boxes beside.
    Float8 corners(const View& v) const {
        Float8 nearest = broadcast(std::numeric_limits<float>::infinity());
        for (unsigned corner = 0; corner < 8; ++corner) {
            const std::array<Float8, 3> p = {corner & 1 ? v.upper[0] : v.lower[0], corner & 2 ? v.upper[1] : v.lower[1],
                                             corner & 4 ? v.upper[2] : v.lower[2]};
            const Float8 along = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
            const Float8 on_normal = n[0] * p[0] + n[1] * p[1] + n[2] * p[2];
            Float8 square{};
            for (std::size_t i = 0; i < 3; ++i) {
                const Float8 across = p[i] - along * w[i];
                square += across * across;
            }
            const Int32x8 inside = (along >= begin) & (on_normal <= far);
            nearest = inside ? least(nearest, square / (along * along)) : nearest;
        }
        for (int lane = 0; lane < lanes; ++lane)
            if (!(v.beside >> lane & 1)) nearest[lane] = std::numeric_limits<float>::infinity();
        return nearest;
    }

  private:
    static constexpr float slack = 1e-5f;  // relative; many times what is rounded

    Float8 relative(Float8 v, std::size_t i) const {
        const double o = edge.apex[static_cast<int>(i)];
        const Float4 low = __builtin_convertvector(low_half(v) - o, Float4);
        const Float4 high = __builtin_convertvector(high_half(v) - o, Float4);
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
};

// Visits the nodes that the edge meets, with what is seen of their boxes.
template <class Visit>
void ConeFinder::visit_met(const Query& query, const Visit& visit) {
    if (boxes_->empty()) return;
    stack_.assign(1, &boxes_->root());
    while (!stack_.empty()) {
        const BoxHierarchy::Node& node = *stack_.back();
        stack_.pop_back();
        const Query::View view = query.view(node);
        visit(node, view);
        for_each_bit(view.met & ~node.leaves, [&](int lane) { stack_.push_back(&boxes_->child(node, lane)); });
    }
}

double ConeFinder::fast(const Query& query) {
    Float8 least_square = broadcast(std::numeric_limits<float>::infinity());
    visit_met(query, [&](const BoxHierarchy::Node&, const Query::View& view) {
        if (view.beside) least_square = least(least_square, query.corners(view));
    });
    float square = least_square[0];
    for (int lane = 1; lane < lanes; ++lane) square = std::min(square, least_square[lane]);
    return std::sqrt(square);
}

// Best first. Triangles are looked at where they come first by their boxes.
ConeFinder::Entry ConeFinder::refined(const Query& query, std::size_t boxes) {
    const auto wider = [](const Entry& a, const Entry& b) { return a.tangent > b.tangent; };
    const auto push = [&](const Entry& entry) {
        queue_.push_back(entry);
        std::push_heap(queue_.begin(), queue_.end(), wider);
    };
    queue_.clear();
    visit_met(query, [&](const BoxHierarchy::Node& node, const Query::View& view) {
        for_each_bit(view.beside | (view.met & node.leaves), [&](int lane) {
            queue_.push_back({view.bound(lane), &node, lane, false});
        });
    });
    std::make_heap(queue_.begin(), queue_.end(), wider);
    while (!queue_.empty()) {
        std::pop_heap(queue_.begin(), queue_.end(), wider);
        Entry narrowest = queue_.back();
        queue_.pop_back();
        const bool leaf = narrowest.node->leaf(narrowest.lane);
        if (leaf && !narrowest.exact) {
            const auto& triangle = boxes_->triangle(*narrowest.node, narrowest.lane);
            narrowest.tangent = least_tangent(query.slab, query.edge.apex, triangle);
            narrowest.exact = true;
            if (narrowest.tangent < query.tan_max) push(narrowest);
            continue;
        }
        // The narrowest itself is one of them.
        if (leaf || queue_.size() + 1 >= boxes) return narrowest;
        const BoxHierarchy::Node& node = boxes_->child(*narrowest.node, narrowest.lane);
        const Query::View view = query.view(node);
        for_each_bit(view.beside | view.met, [&](int lane) { push({view.bound(lane), &node, lane, false}); });
    }
    return {infinity, nullptr, 0, true};
}

double ConeFinder::operator()(const ConeEdge& edge) {
    const Query query(edge, settings_, tan_tau_);
    const double tangent = settings_.estimator == ConeEstimator::fast ? fast(query)
                           : settings_.estimator == ConeEstimator::bvh_cut
                               ? refined(query, static_cast<std::size_t>(settings_.boxes)).tangent
                               : refined(query, all_boxes).tangent;
    return std::clamp(std::atan(tangent), settings_.tau_min, settings_.tau_max);
}

std::optional<Vec3> ConeFinder::contact(const ConeEdge& edge) {
    const Entry nearest = refined(Query(edge, settings_, tan_tau_), all_boxes);
    if (!nearest.node) return std::nullopt;
    const Slab slab(edge, settings_);
    Outline outline(slab);
    add_triangle(outline, edge.apex, boxes_->triangle(*nearest.node, nearest.lane));
    outline.tangent();
    return edge.apex + outline.where();
}

}  // namespace keyhole
