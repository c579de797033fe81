// The moves of src/strategies on the toy of chart_toy.h, and the rules that they may get wrong.
#pragma once

#include <string_view>

#include "chart_toy.h"

namespace keyhole {

// Numbers of chart 1 that its inverse does not lead back to, at positions in a region.
enum class ToyFailures { none, all_branches, one_branch };

// The wrong ones are switched on by tests that expect to see them fail.
struct ToyRules {
    BranchRule branch = BranchRule::posterior;
    bool component_densities = false;  // the swap's ratio accounts for how the inverse chose the branch
    bool position_reads_lobe = false;  // the position is made of the lobe's number
    ToyFailures failures = ToyFailures::none;
    bool out_refused = true;       // where the own inverse fails, moves out of the chart are refused as those into it
    bool in_chart_refused = true;  // and moves within the chart, if states forget their numbers
    bool own_numbers = true;       // the own inverse is that to the state's numbers, not to any drawn until some do
};

class ToyMoves {
  public:
    // `forgets`: some move of the mix leaves states without numbers.
    ToyMoves(const ToyRules& rules, bool forgets) : rules_(rules), forgets_(forgets) {}

    Proposal small_step(ToyState& x, ToyState& y, Rng& random) const {
        if (!start_move(x, random)) return Proposal::failed(Failure::inverse_failed);
        y.t = x.t;
        step(x.u, y.u, random);
        return finish_move(x, y, 1, random);
    }

    // t ~ q(t), u uniform.
    Proposal large_step(ToyState& x, ToyState& y, Rng& random) const {
        find_technique(x, random);
        y.t = static_cast<int>(draw(q_, random));
        for (double& u : y.u) u = random.uniform();
        if (!evaluate(y)) return Proposal::failed(Failure::zero_bsdf);
        return {toy_target(y.x) / q(y.t) * q(x.t) / toy_target(x.x)};
    }

    // Same numbers, another chart.
    Proposal technique_change(ToyState& x, ToyState& y, Rng& random) const {
        if (!start_move(x, random)) return Proposal::failed(Failure::inverse_failed);
        y.t = draw_other(x.t, q_, random);
        y.u = x.u;
        return finish_move(x, y, q(x.t) * (1 - q(x.t)) / (q(y.t) * (1 - q(y.t))), random);
    }

    Proposal chart_swap(ToyState& x, ToyState& y, Rng& random) const {
        find_technique(x, random);
        const PerChart q_x = possible(x.x);
        const int t = draw_other(x.t, q_x, random);
        if (!go_over(x, t, y, random)) return Proposal::failed(Failure::inverse_failed);
        const double choices = q(x.t) * (sum(q_x) - q(x.t)) / (q(t) * (sum(q_x) - q(t)));
        return {toy_pdf(t, x.x) / toy_pdf(x.t, x.x) * choices * (rules_.component_densities ? branch_ratio(x, y) : 1)};
    }

    // t ~ w_t(x).
    Proposal chart_gibbs(ToyState& x, ToyState& y, Rng& random) const {
        find_technique(x, random);
        const int t = static_cast<int>(draw(toy_weights(x.x), random));
        if (t == x.t) return Proposal::failed(Failure::unchanged);
        if (!go_over(x, t, y, random)) return Proposal::failed(Failure::inverse_failed);
        return {1};
    }

    Proposal inverse_small_step(ToyState& x, ToyState& y, Rng& random) const {
        const PerChart q_x = possible(x.x);
        const int t = draw_in_proportion(q_x, random);
        ToyNumbers u = x.u;
        if (!invert(t, x.x, u, random)) return Proposal::failed(Failure::inverse_failed);
        y.t = t;
        step(u, y.u, random);
        if (!evaluate(y)) return Proposal::failed(Failure::zero_bsdf);
        if (!own_inverse(y, random)) return Proposal::failed(Failure::inverse_failed);
        y.known = Known::path;
        const auto estimate = [&](double position) { return interval_target(position) / toy_pdf(t, position); };
        return {estimate(y.x) / estimate(x.x) * sum(q_x) / sum(possible(y.x))};
    }

  private:
    static double q(int t) { return q_[static_cast<std::size_t>(t)]; }
    // q(t) of the charts that can make x.
    static PerChart possible(double x) {
        PerChart p = q_;
        for (int t = 0; t < toy_charts; ++t)
            if (!(toy_pdf(t, x) > 0)) p[static_cast<std::size_t>(t)] = 0;
        return p;
    }
    static double sum(const PerChart& p) { return p[0] + p[1] + p[2]; }

    static int draw_in_proportion(PerChart weights, Rng& random) {
        const double all = sum(weights);
        for (double& w : weights) w /= all;
        return static_cast<int>(draw(weights, random));
    }
    static int draw_other(int t, PerChart weights, Rng& random) {
        weights[static_cast<std::size_t>(t)] = 0;
        return draw_in_proportion(weights, random);
    }

    static void step(const ToyNumbers& from, ToyNumbers& to, Rng& random) {
        for (std::size_t i = 0; i < from.size(); ++i) to[i] = wrapped(from[i] + draw_triangular(0.25, random));
    }

    // y = T_t(u). False outside of the target's support.
    bool evaluate(ToyState& y) const {
        y.x = toy_branches(y.t)[toy_branch(y.t, y.u)].position(y.u[rules_.position_reads_lobe ? 0 : 1]);
        y.known = Known::coordinates;
        y.inverse_found = false;
        return interval_target(y.x) > 0;
    }

    bool leads_back(int t, double x, const ToyNumbers& u) const {
        if (rules_.failures == ToyFailures::none || t != 1 || !failing_.holds(x)) return true;
        return rules_.failures == ToyFailures::one_branch && toy_branch(t, u) != 2;
    }
    bool invert(int t, double x, ToyNumbers& u, Rng& random) const {
        invert_toy(rules_.branch, t, x, u, random);
        return leads_back(t, x, u);
    }

    void find_technique(ToyState& x, Rng& random) const {
        if (x.known != Known::path) return;
        x.t = static_cast<int>(draw(toy_weights(x.x), random));
        x.known = Known::technique;
        x.inverse_found = false;
    }
    // Numbers that do not lead back are kept and remembered as such; else they are drawn anew each time.
    bool find_coordinates(ToyState& x, Rng& random) const {
        find_technique(x, random);
        if (x.known == Known::coordinates) return true;
        x.inverse_found = invert(x.t, x.x, x.u, random);
        if (x.inverse_found || rules_.own_numbers) x.known = Known::coordinates;
        return x.known == Known::coordinates;
    }

    // Whether x's own chart leads back to x.
    bool own_inverse(ToyState& x, Rng& random) const {
        if (rules_.own_numbers) return find_coordinates(x, random) && leads_back(x.t, x.x, x.u);
        ToyNumbers any = x.u;
        return x.inverse_found = x.inverse_found || invert(x.t, x.x, any, random);
    }

    // y becomes x in chart t.
    bool go_over(ToyState& x, int t, ToyState& y, Rng& random) const {
        if (rules_.out_refused && !own_inverse(x, random)) return false;
        y.x = x.x;
        y.t = t;
        y.u = x.u;
        y.known = Known::coordinates;
        return y.inverse_found = invert(t, x.x, y.u, random);
    }

    // What the inverse's choice of the branch adds to the ratio (theory, section 4).
    double branch_ratio(const ToyState& x, const ToyState& y) const {
        const auto chosen = [&](BranchRule rule, const ToyState& s) {
            return branch_probability(rule, s.t, x.x, toy_branch(s.t, s.u));
        };
        return chosen(BranchRule::posterior, y) * chosen(rules_.branch, x) /
               (chosen(BranchRule::posterior, x) * chosen(rules_.branch, y));
    }

    // Moves in the chart of x, which has numbers, may start or end there.
    bool may_move_in_chart(ToyState& x, Rng& random) const {
        return !forgets_ || !rules_.in_chart_refused || own_inverse(x, random);
    }
    bool start_move(ToyState& x, Rng& random) const {
        return find_coordinates(x, random) && may_move_in_chart(x, random);
    }
    Proposal finish_move(const ToyState& x, ToyState& y, double factor, Rng& random) const {
        if (!evaluate(y)) return Proposal::failed(Failure::zero_bsdf);
        if (!may_move_in_chart(y, random)) return Proposal::failed(Failure::inverse_failed);
        return {toy_target(y.x) / toy_target(x.x) * factor};
    }

    static constexpr PerChart q_ = {0.5, 0.2, 0.3};
    static constexpr Interval failing_ = {0.2, 0.45};

    ToyRules rules_;
    bool forgets_;
};

struct ToyMove {
    std::string_view name;
    Proposal (ToyMoves::*propose)(ToyState&, ToyState&, Rng&) const;
    bool forgets = false;
};

inline constexpr ToyMove toy_small_step{"small-step", &ToyMoves::small_step};
inline constexpr ToyMove toy_large_step{"large-step", &ToyMoves::large_step};
inline constexpr ToyMove toy_technique_change{"technique-change", &ToyMoves::technique_change};
inline constexpr ToyMove toy_chart_swap{"chart-swap", &ToyMoves::chart_swap};
inline constexpr ToyMove toy_chart_gibbs{"chart-gibbs", &ToyMoves::chart_gibbs};
inline constexpr ToyMove toy_inverse_small_step{"inverse-small-step", &ToyMoves::inverse_small_step, true};

inline constexpr std::array<ToyMove, 6> toy_moves = {toy_small_step, toy_large_step,  toy_technique_change,
                                                     toy_chart_swap, toy_chart_gibbs, toy_inverse_small_step};

}  // namespace keyhole
