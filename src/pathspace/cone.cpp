#include "pathspace/cone.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "pathspace/triangle_angle.h"

namespace keyhole {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t all_boxes = std::numeric_limits<std::size_t>::max();

template <class Body>
void for_each_bit(unsigned bits, const Body& body) {
    for (; bits; bits &= bits - 1) body(std::countr_zero(bits));
}

}  // namespace

ConeFinder::ConeFinder(const BoxHierarchy& boxes, const ConeSettings& settings)
    : boxes_(&boxes), settings_(settings), tan_tau_(std::tan(settings.tau_max)) {
    stack_.reserve(256);
    queue_.reserve(1024);
}

// What is computed once for an edge. Eight boxes are looked at at once, in single precision relative to the apex; what
// is decided so allows for its rounding, so that no box is left out and no bound too large.
struct ConeFinder::Query {
    const ConeEdge& edge;
    ConeSlab slab;
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
    return nearest_to_axis(ConeSlab(edge, settings_), edge.apex, boxes_->triangle(*nearest.node, nearest.lane));
}

}  // namespace keyhole
