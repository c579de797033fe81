// Three charts over positions in [0, 1) that choose among branches, as BSDFs do among lobes: a small copy of the moves
// of src/strategies whose answer is known. In a chart, number 0 chooses a lobe, number 2 one of its sides if the lobe
// has two (else nothing reads it), and number 1 the position, with the density of the branch that was chosen.
#pragma once

#include <array>
#include <span>

#include "interval_target.h"

namespace keyhole {

struct Interval {
    double low = 0, high = 1;

    double length() const { return high - low; }
    bool holds(double v) const { return low <= v && v < high; }
    double at(double fraction) const { return std::min(low + fraction * length(), std::nextafter(high, low)); }
    double fraction(double v) const { return clamp01((v - low) / length()); }
};

// A lobe, or one side of it.
struct Branch {
    Interval lobe, side;  // of numbers 0 and 2; a side of [0, 1) is not read
    Interval range;       // of x
    double slope;         // density of x: [1 + slope (2 v - 1)] / length with v its fraction of the range

    double probability() const { return lobe.length() * side.length(); }
    double pdf(double x) const {
        return range.holds(x) ? (1 + slope * (2 * range.fraction(x) - 1)) / range.length() : 0;
    }
    double position(double u) const {
        const double a = 1 - slope;
        return range.at(2 * u / (a + std::sqrt(a * a + 4 * slope * u)));
    }
    double number(double x) const {
        const double v = range.fraction(x);
        return clamp01(v * (1 - slope) + slope * v * v);
    }
};

inline constexpr int toy_charts = 3;
using PerChart = std::array<double, toy_charts>;

namespace toy_chart {
inline constexpr std::array<Branch, 3> two_sides_above = {
    {{{0, 0.3}, {0, 1}, {0, 1}, 0.6}, {{0.3, 1}, {0, 0.4}, {0, 0.5}, -0.8}, {{0.3, 1}, {0.4, 1}, {0.3, 1}, 0.5}}};
inline constexpr std::array<Branch, 3> two_sides_below = {
    {{{0, 0.55}, {0, 0.25}, {0, 1}, -0.9}, {{0, 0.55}, {0.25, 1}, {0.6, 1}, 0.2}, {{0.55, 1}, {0, 1}, {0, 0.7}, 0.9}}};
// Makes no position of 0.5 or above.
inline constexpr std::array<Branch, 2> one_side = {
    {{{0, 0.8}, {0, 1}, {0, 0.4}, 0.3}, {{0.8, 1}, {0, 1}, {0.2, 0.5}, -0.7}}};
}  // namespace toy_chart

inline std::span<const Branch> toy_branches(int t) {
    if (t == 0) return toy_chart::two_sides_above;
    if (t == 1) return toy_chart::two_sides_below;
    return toy_chart::one_side;
}

// p_t(x), w_t(x) of all charts, and C(x) = f(x) / sum p.
inline double toy_pdf(int t, double x) {
    double sum = 0;
    for (const Branch& b : toy_branches(t)) sum += b.probability() * b.pdf(x);
    return sum;
}
inline double toy_pdf_of_all(double x) { return toy_pdf(0, x) + toy_pdf(1, x) + toy_pdf(2, x); }
inline PerChart toy_weights(double x) {
    const double all = toy_pdf_of_all(x);
    return {toy_pdf(0, x) / all, toy_pdf(1, x) / all, toy_pdf(2, x) / all};
}
inline double toy_target(double x) { return interval_target(x) / toy_pdf_of_all(x); }

using ToyNumbers = std::array<double, 3>;

inline std::size_t toy_branch(int t, const ToyNumbers& u) {
    const auto branches = toy_branches(t);
    std::size_t l = 0;
    while (!branches[l].lobe.holds(u[0]) || !branches[l].side.holds(u[2])) ++l;
    return l;
}

// As PssState: the path always holds, the rest as far as it is known.
enum class Known { path, technique, coordinates };

struct ToyState {
    double x = 0;
    int t = 0;
    ToyNumbers u{};
    Known known = Known::coordinates;
    bool inverse_found = false;
};

// How an inverse chooses the branch and its numbers; all but the first are wrong in their own way, unless the ratio of
// the swap accounts for the choice.
enum class BranchRule {
    posterior,      // c_l p_l(x) / p(x); numbers uniform in the branch's intervals
    prior,          // c_l among the branches that can make x
    fixed,          // the first branch that can make x
    stale_numbers,  // posterior, but what the branch does not read stays what it was
    shared_number   // posterior, but the lobe's number is made of the position's
};

// P(branch l | x) of the inverse of chart t.
inline double branch_probability(BranchRule rule, int t, double x, std::size_t l) {
    const auto branches = toy_branches(t);
    const auto weight = [&](const Branch& b) {
        return rule == BranchRule::prior ? (b.pdf(x) > 0 ? b.probability() : 0) : b.probability() * b.pdf(x);
    };
    double sum = 0, before = 0;
    for (std::size_t i = 0; i < branches.size(); ++i) {
        if (i < l) before += weight(branches[i]);
        sum += weight(branches[i]);
    }
    const double own = weight(branches[l]);
    return rule == BranchRule::fixed ? (own > 0 && before == 0 ? 1 : 0) : own / sum;
}

// u = R_t(x), over the old numbers.
inline void invert_toy(BranchRule rule, int t, double x, ToyNumbers& u, Rng& random) {
    const auto branches = toy_branches(t);
    std::array<double, 3> probabilities{};
    for (std::size_t l = 0; l < branches.size(); ++l) probabilities[l] = branch_probability(rule, t, x, l);
    const Branch& b = branches[draw({probabilities.data(), branches.size()}, random)];
    u[1] = b.number(x);
    u[0] = b.lobe.at(rule == BranchRule::shared_number ? u[1] : random.uniform());
    const bool read = b.side.length() < 1;
    if (read || rule != BranchRule::stale_numbers) u[2] = b.side.at(random.uniform());
}

// The joint distribution of (x, t, branch, numbers): cells of a tenth in x, and the halves of the branch's intervals,
// in which numbers 0 and 2 are uniform. (Number 1 follows from x and the branch.)
inline constexpr std::size_t toy_x_cells = 10, toy_cells = toy_charts * 3 * toy_x_cells * 4;

inline std::size_t toy_cell(const ToyState& s) {
    const std::size_t l = toy_branch(s.t, s.u);
    const Branch& b = toy_branches(s.t)[l];
    const std::size_t half_lobe = b.lobe.fraction(s.u[0]) < 0.5 ? 0 : 1,
                      half_side = b.side.fraction(s.u[2]) < 0.5 ? 0 : 1;
    const auto x = static_cast<std::size_t>(s.x * toy_x_cells);
    return ((static_cast<std::size_t>(s.t) * 3 + l) * toy_x_cells + x) * 4 + 2 * half_lobe + half_side;
}

// pi(x, t, branch) = w_t f c_l p_l / p_t by the midpoint rule, exact to 1e-6: pieces end at multiples of 1/20.
inline std::vector<double> expected_in_toy_cells(double total) {
    constexpr int points = 400;
    std::vector<double> mass(toy_cells);
    for (std::size_t cell = 0; cell < toy_cells; ++cell) {
        const int t = static_cast<int>(cell / (3 * toy_x_cells * 4));
        const std::size_t l = cell / (toy_x_cells * 4) % 3;
        if (l >= toy_branches(t).size()) continue;
        for (int i = 0; i < points; ++i) {
            const double x = (static_cast<double>(cell / 4 % toy_x_cells) + (i + 0.5) / points) / toy_x_cells;
            const Branch& b = toy_branches(t)[l];
            mass[cell] += interval_target(x) * b.probability() * b.pdf(x) / toy_pdf_of_all(x);
        }
    }
    return scaled(mass, total);
}

// What a state has forgotten, drawn from its conditional distribution.
inline void complete_toy(ToyState& s, Rng& random) {
    if (s.known == Known::path) s.t = static_cast<int>(draw(toy_weights(s.x), random));
    if (s.known != Known::coordinates) invert_toy(BranchRule::posterior, s.t, s.x, s.u, random);
    s.known = Known::coordinates;
}

inline ToyState draw_toy_state(Rng& random) {
    ToyState s{draw_from_interval_target(random), 0, {}, Known::path};
    complete_toy(s, random);
    return s;
}

}  // namespace keyhole
