// densities_of_the_branches: what `pdf` and `invert` say against finite differences of `sample`.
#include <array>
#include <cmath>
#include <map>

#include "base/rng.h"
#include "bsdf_harness.h"

namespace keyhole {
namespace {

// One way to draw a direction: a lobe and the numbers within it.
struct Branch {
    BsdfNumbers numbers;
    double chosen = 0;   // share of the inverse's branch numbers that lead to it
    double density = 0;  // c_l p_l(w)
};

struct Sampler {
    const BsdfCase& c;
    const Vec3& known;
    Mode mode;

    std::optional<BsdfSample> operator()(double u_lobe, const Vec2& u) const {
        return c.bsdf->sample(c.x, known, u_lobe, u, mode);
    }
    bool chooses(double u_lobe, const Vec2& u, int lobe) const {
        const auto s = (*this)(u_lobe, u);
        return s && !s->delta && s->lobe == lobe;
    }
    // Length of the interval of lobe numbers about n.lobe that choose the lobe.
    double probability(const BsdfNumbers& n, int lobe) const {
        const auto end = [&](double outside) {
            double inside = n.lobe;
            if (chooses(outside, n.direction, lobe)) return outside;
            for (int i = 0; i < 50; ++i) {
                const double middle = 0.5 * (inside + outside);
                (chooses(middle, n.direction, lobe) ? inside : outside) = middle;
            }
            return inside;
        };
        return end(one_minus_epsilon) - end(0);
    }
    // |dw / du| by central differences; empty where two steps do not agree, as at the kinks of a warp.
    std::optional<double> jacobian(const BsdfNumbers& n, int lobe) const {
        const auto with_step = [&](double h) -> std::optional<double> {
            std::array<Vec3, 2> d;
            for (int i = 0; i < 2; ++i) {
                Vec2 a = n.direction, b = n.direction;
                a[i] -= h;
                b[i] += h;
                if (a[i] < 0 || b[i] >= 1) return std::nullopt;
                const auto from = (*this)(n.lobe, a), to = (*this)(n.lobe, b);
                if (!from || !to || from->lobe != lobe || to->lobe != lobe) return std::nullopt;
                d[static_cast<std::size_t>(i)] = (to->w - from->w) / (2 * h);
            }
            return d[0].cross(d[1]).norm();
        };
        const auto coarse = with_step(2e-5), fine = with_step(1e-5);
        if (!coarse || !fine || std::abs(*coarse - *fine) > 1e-4 * *fine) return std::nullopt;
        return fine;
    }
};

}  // namespace

testing::AssertionResult densities_of_the_branches(const BsdfCase& c) {
    constexpr int draws = 12, branch_numbers = 128;
    if (!c.bsdf->traits().smooth) return testing::AssertionSuccess();
    Rng rng(7);
    int checked = 0, drawn = 0;
    for (const Vec3& known : known_directions())
        for (const Mode mode : {Mode::eye, Mode::light})
            for (int i = 0; i < draws; ++i) {
                const Sampler sample{c, known, mode};
                const double u_lobe = rng.uniform(), u1 = rng.uniform();
                const auto s = sample(u_lobe, {u1, rng.uniform()});
                if (!s || s->delta) continue;
                ++drawn;
                std::map<int, Branch> branches;
                InverseNumbers v = fresh_numbers(rng);
                for (int b = 0; b < branch_numbers; ++b) {
                    v.branch = (b + 0.5) / branch_numbers;
                    const auto n = c.bsdf->invert(c.x, known, s->w, {}, v, mode);
                    if (!n) return testing::AssertionFailure() << "no inverse of (" << s->w.transpose() << ")";
                    const auto again = sample(n->lobe, n->direction);
                    if (!again) return testing::AssertionFailure() << "no sample from an inverse";
                    Branch& branch = branches[again->lobe];
                    branch.numbers = *n;
                    branch.chosen += 1.0 / branch_numbers;
                }
                double density = 0;
                bool smooth = true;
                for (auto& [lobe, branch] : branches) {
                    const auto jacobian = sample.jacobian(branch.numbers, lobe);
                    smooth = smooth && jacobian && *jacobian > 0;
                    if (!smooth) break;
                    branch.density = sample.probability(branch.numbers, lobe) / *jacobian;
                    density += branch.density;
                }
                if (!smooth) continue;
                ++checked;
                const auto where = [&]() -> testing::AssertionResult {
                    return testing::AssertionFailure() << "(" << known.transpose() << ") to (" << s->w.transpose()
                                                       << "), " << (mode == Mode::eye ? "eye" : "light") << ": ";
                };
                // Lobes that no branch number of the grid leads to have a share below its step.
                if (std::abs(density - s->pdf) >
                    (1e-3 + 1.0 / branch_numbers * (c.bsdf->traits().chooses_lobe ? 1 : 0)) * s->pdf)
                    return where() << "density " << s->pdf << ", the sum over " << branches.size() << " branches is "
                                   << density;
                for (const auto& [lobe, branch] : branches)
                    if (std::abs(branch.chosen - branch.density / density) > 2.0 / branch_numbers)
                        return where() << "lobe " << lobe << " is " << branch.density / density
                                       << " of the density, but the inverse's choice in " << branch.chosen;
            }
    if (2 * checked < drawn)
        return testing::AssertionFailure() << "only " << checked << " of " << drawn << " samples could be checked";
    return testing::AssertionSuccess();
}

}  // namespace keyhole
