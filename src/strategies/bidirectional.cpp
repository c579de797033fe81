#include "strategies/bidirectional.h"

#include <algorithm>
#include <cmath>

#include "strategies/technique_distribution.h"

namespace keyhole {
namespace {

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();

// Veach's p_{d,1} by the number of deleted edges, d + 1; not normalised.
double deletion_weight(int deleted) {
    return deleted == 0 ? 0.25 : deleted == 1 ? 0.5 : std::ldexp(1.0, -(deleted + 1));
}
double total_deletion_weight(int k) {
    double sum = 0;
    for (int d = 0; d <= k + 1; ++d) sum += deletion_weight(d);
    return sum;
}

// Places x_l of the last vertex kept at the eye's end: neither end keeps the other's endpoint, and x_0 is not kept at
// the light's end.
struct Places {
    int first, last;
    Places(int k, int deleted) : first(deleted == 0 ? 0 : -1), last(std::min(k - 1, k - deleted)) {}
    int count() const { return last - first + 1; }
};

// How many of the `added` vertices may come from the eye: the sensor does, and a path of one edge is made from it
// alone.
struct EyeShares {
    int first, last;
    EyeShares(int eye, int light, int added) : first(eye == 0 ? 1 : 0), last(added) {
        if (eye + added + light == 2) {
            first = added;
            if (light > 0) last = first - 1;
        }
    }
    int count() const { return std::max(0, last - first + 1); }
};

void draw(Rng& rng, Vec2& u) {
    u.x() = rng.uniform();
    u.y() = rng.uniform();
}

}  // namespace

Bidirectional::Split Bidirectional::choose_deletion(int k, Rng& rng) const {
    const int deleted = draw_index(k + 2, total_deletion_weight(k), deletion_weight, rng);
    const Places places(k, deleted);
    const int l = places.first + static_cast<int>(rng.below(static_cast<std::uint64_t>(places.count())));
    return {l + 1, k - l - deleted, deleted};
}

double Bidirectional::log_deletion(const Split& s) const {
    const int k = s.length();
    return std::log(deletion_weight(s.between) / (total_deletion_weight(k) * Places(k, s.between).count()));
}

double Bidirectional::addition_weight(const Split& s, int added) const {
    const int length = s.eye + added + s.light - 1, change = std::abs(added - s.between);
    if (lengths_.fixed ? change != 0 : length < lengths_.min || length > lengths_.max) return 0;
    // The emitter's end is not left without a vertex of its own, as x_k cannot be kept at the eye's.
    if (length < 1 || (added == 0 && (s.between == 0 || s.light == 0))) return 0;
    if (EyeShares(s.eye, s.light, added).count() == 0) return 0;
    return change == 0 ? 0.5 : change == 1 ? 0.15 : 0.2 * std::ldexp(1.0, -change);
}

double Bidirectional::total_addition_weight(const Split& s) const {
    double sum = 0;
    for (int a = 0; s.eye + a + s.light - 1 <= lengths_.max; ++a) sum += addition_weight(s, a);
    return sum;
}

int Bidirectional::choose_addition(const Split& s, Rng& rng) const {
    const double total = total_addition_weight(s);
    if (!(total > 0)) return -1;
    return draw_index(
        lengths_.max + 2 - s.eye - s.light, total, [&](int a) { return addition_weight(s, a); }, rng);
}

double Bidirectional::log_density(const Split& from, const Split& to, const PssState& made) const {
    const EyeShares shares(to.eye, to.light, to.between);
    const auto log_product = [](const std::vector<double>& p, int begin, int end) {
        double sum = 0;
        for (int i = begin; i < end; ++i) sum += std::log(p[static_cast<std::size_t>(i)]);
        return sum;
    };
    const int end = to.eye + to.between;
    double largest = minus_infinity, sum = 0;
    for (int j = shares.first; j <= shares.last; ++j) {
        const int t = to.eye + j;
        if (!technique_exists(made.path.x(), t)) continue;
        const double term = log_product(made.measure.eye, to.eye, t) + log_product(made.measure.light, t, end);
        if (!(term > minus_infinity)) continue;
        if (term > largest) {
            sum = sum * std::exp(largest - term) + 1;
            largest = term;
        } else {
            sum += std::exp(term - largest);
        }
    }
    if (!(sum > 0)) return minus_infinity;
    return log_deletion(from) + std::log(addition_weight(from, to.between) / total_addition_weight(from)) + largest +
           std::log(sum / shares.count());
}

Failure Bidirectional::grow(const PssState& x, PssState& y, const Split& to, int from_eye, Rng& rng) const {
    const int k = to.length(), t = to.eye + from_eye, s = k + 1 - t;
    y.path.k = k;
    Vertex* const v = y.path.room.data();
    std::copy_n(x.path.room.data(), to.eye, v);
    std::copy_n(x.path.room.data() + x.path.k + 1 - to.light, to.light, v + k + 1 - to.light);
    Vec2 u;
    for (int i = to.eye; i < t; ++i) {
        draw(rng, u);
        Extension e = Extension::surface;
        if (i == 0) {
            start_eye(scene(), u, v[0]);
        } else if (i == 1) {
            e = first_eye_edge(tracer(), window(), window().at(u), v[0], v[1]);
        } else {
            if (i == to.eye) orient(v[i - 2], v[i - 1]);
            e = extend(tracer(), Mode::eye, v[i - 2], v[i - 1], v[i], rng.uniform(), u);
        }
        if (i == k ? !(e == Extension::surface || e == Extension::escaped) || !v[i].x.emitter : e != Extension::surface)
            return Failure::eye_subpath_short;
    }
    for (int i = k - to.light; i >= t; --i) {
        draw(rng, u);
        if (i == k) {
            const double choice = rng.uniform(), part = rng.uniform();
            if (!start_light(scene(), choice, part, u, v[k])) return Failure::light_subpath_short;
            continue;
        }
        Extension e;
        if (i == k - 1) {
            v[k].throughput = Spectrum::Ones();
            e = first_light_edge(tracer(), u, v[k], v[i]);
        } else {
            if (i == k - to.light) orient(v[i + 2], v[i + 1]);
            e = extend(tracer(), Mode::light, v[i + 2], v[i + 1], v[i], rng.uniform(), u);
        }
        if (e != Extension::surface) return Failure::light_subpath_short;
    }
    if (s == 0) return to_failure(charts_.complete(y));
    if (!(t == 1 || connectable(v[t - 1])) || !(s == 1 || connectable(v[t]))) return Failure::zero_bsdf;
    if (const PathFailure failure = charts_.complete(y); failure != PathFailure::none) return to_failure(failure);
    return visible(tracer(), v[t - 1], v[t]) ? Failure::none : Failure::occluded;
}

Proposal Bidirectional::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!charts_.measure(x)) return Proposal::failed(Failure::other);
    const Split from = choose_deletion(x.path.k, rng);
    const int added = choose_addition(from, rng);
    if (added < 0) return Proposal::failed(Failure::unchanged);
    const Split to{from.eye, from.light, added};
    const EyeShares shares(to.eye, to.light, added);
    const int from_eye = shares.first + static_cast<int>(rng.below(static_cast<std::uint64_t>(shares.count())));
    if (const Failure failure = grow(x, y, to, from_eye, rng); failure != Failure::none)
        return Proposal::failed(failure);
    return proposal(x, y, log_density(from, to, y), log_density(to, from, x));
}

}  // namespace keyhole
