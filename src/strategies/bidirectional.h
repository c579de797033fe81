// The bidirectional mutation [Veach and Guibas 1997, 5.3.1]: deletes a subpath and grows another in its place from both
// ends.
#pragma once

#include "strategies/path_lengths.h"
#include "strategies/path_move.h"

namespace keyhole {

// The kept ends are x_0 .. x_l and x_m .. x_k; l = -1 and m = k + 1 where an end is deleted as a whole. The d = m - l -
// 1 vertices between give way to a others, j of them from the eye's side:
//     T(x -> y) = p_d(d, l | k) p_a(a | d) sum_j p(j | a) prod E_i(y) prod L_i(y),
// the sum over all ways in which the same vertices could have been made, E_i and L_i the densities of y_i from either
// side.
class Bidirectional final : public PathMove {
  public:
    // `lengths` are resolved.
    Bidirectional(ChartEvaluator& charts, const PathLengths& lengths) : PathMove(charts), lengths_(lengths) {}
    std::string_view name() const override { return "bidirectional"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    // What is kept of a path and how many vertices are between.
    struct Split {
        int eye, light;  // kept vertices of either end
        int between;
        int length() const { return eye + between + light - 1; }
    };
    Split choose_deletion(int k, Rng& rng) const;
    double log_deletion(const Split& s) const;
    // p_a, for all numbers of new vertices; 0 where the path would be too short or too long.
    double addition_weight(const Split& s, int added) const;
    double total_addition_weight(const Split& s) const;
    int choose_addition(const Split& s, Rng& rng) const;
    // ln T without what is common to both ways.
    double log_density(const Split& from, const Split& to, const PssState& made) const;
    Failure grow(const PssState& x, PssState& y, const Split& to, int from_eye, Rng& rng) const;

    PathLengths lengths_;
};

}  // namespace keyhole
