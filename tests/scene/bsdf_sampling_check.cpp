// sampling_follows_pdf: chi-square of `sample` against the density of `eval`.
#include <array>
#include <functional>
#include <map>

#include "base/rng.h"
#include "bsdf_harness.h"
#include "scene/fresnel.h"
#include "statistics.h"

namespace keyhole {
namespace {

constexpr int samples = 30000;
constexpr int rows = 20, columns = 16;

using Density = std::function<double(const Vec3&)>;

// One side of the surface in polar coordinates about `axis` (where narrow lobes sit) that crowd the cells there:
// cos theta = 1 - 2 s^4, domega = 8 s^3 ds dphi. The columns are turned so that the horizon, where densities end, runs
// through the middle of cells: a sliver along a border would be missed by the quadrature.
class Grid {
  public:
    Grid(const Vec3& axis, const Density& density)
        : side_(std::copysign(1.0, axis.z())), frame_(Frame::from_normal(axis)), density_(density) {
        if (std::abs(axis.z()) < 0.999) frame_ = Frame::from_normal_and_tangent(axis, Vec3::UnitZ());
        const Vec3 s = frame_.s * std::cos(0.1) + frame_.t * std::sin(0.1);
        frame_ = {s, axis.cross(s), axis};
    }

    bool contains(const Vec3& w) const { return w.z() * side_ > 0; }

    static std::size_t cell(std::size_t row, std::size_t column) { return row * columns + column; }

    std::size_t cell_of(const Vec3& w) const {
        const Vec3 local = frame_.to_local(w);
        const double s = std::pow(std::max(0.0, (1 - local.z()) / 2), 0.25);
        const double phi = std::atan2(local.y(), local.x()) + pi;
        const auto index = [](double t, int n) { return static_cast<std::size_t>(std::min(t * n, n - 1.0)); };
        return cell(index(s, rows), index(phi / (2 * pi), columns));
    }

    // Probability of a cell; cells that hold many samples are refined at least twice, so no peak is missed.
    double probability(std::size_t row, std::size_t column, double count) const {
        const double s0 = double(row) / rows, s1 = double(row + 1) / rows;
        const double p0 = 2 * pi * double(column) / columns - pi, p1 = 2 * pi * double(column + 1) / columns - pi;
        return refine(s0, s1, p0, p1, gauss(s0, s1, p0, p1), count > 10 ? 2 : 1, 9);
    }

  private:
    double value(double s, double phi) const {
        const double h = 2 * s * s * s * s, r = safe_sqrt(h * (2 - h));
        const Vec3 w = frame_.to_world({r * std::cos(phi), r * std::sin(phi), 1 - h}).normalized();
        return contains(w) ? density_(w) * 8 * s * s * s : 0;
    }

    double gauss(double s0, double s1, double p0, double p1) const {
        constexpr std::array<double, 3> node = {-0.7745966692414834, 0, 0.7745966692414834};
        constexpr std::array<double, 3> weight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                sum += weight[i] * weight[j] *
                       value((s0 + s1 + (s1 - s0) * node[i]) / 2, (p0 + p1 + (p1 - p0) * node[j]) / 2);
        return sum * (s1 - s0) * (p1 - p0);
    }

    double refine(double s0, double s1, double p0, double p1, double whole, int least, int most) const {
        const double s = (s0 + s1) / 2, p = (p0 + p1) / 2;
        const std::array<double, 4> part = {gauss(s0, s, p0, p), gauss(s, s1, p0, p), gauss(s0, s, p, p1),
                                            gauss(s, s1, p, p1)};
        const double sum = part[0] + part[1] + part[2] + part[3];
        // 2e-6 of the probability is 0.06 samples: far below the noise of any cell.
        if (most == 0 || (least <= 1 && std::abs(sum - whole) < 2e-6)) return sum;
        return refine(s0, s, p0, p, part[0], least - 1, most - 1) + refine(s, s1, p0, p, part[1], least - 1, most - 1) +
               refine(s0, s, p, p1, part[2], least - 1, most - 1) + refine(s, s1, p, p1, part[3], least - 1, most - 1);
    }

    double side_;
    Frame frame_;
    Density density_;
};

// The known direction's side about its mirror direction, and the other about the refracted one (or straight on, where
// there is none).
std::vector<Grid> both_sides(const BsdfCase& c, const Vec3& known, const Density& density) {
    const double eta = known.z() > 0 ? c.eta : 1 / c.eta;
    const DielectricFresnel fresnel = fresnel_dielectric(std::abs(known.z()), eta);
    const Vec3 through = fresnel.transmittance > 0 ? refract(known, fresnel.cos_t, eta).normalized() : Vec3(-known);
    return {Grid(reflect(known), density), Grid(through, density)};
}

struct DeltaLobe {
    double probability = 0, count = 0;
};

// p-value for one known direction and mode; 0 with a message if the probabilities cannot be right.
double p_value(const BsdfCase& c, const Vec3& known, Mode mode, std::uint64_t stream, std::string& message) {
    const std::vector<Grid> grids = both_sides(c, known, [&](const Vec3& w) {
        return mode == Mode::eye ? c.bsdf->eval(c.x, known, w).pdf_light : c.bsdf->eval(c.x, w, known).pdf_eye;
    });
    std::vector<double> observed(2 * rows * columns), expected;
    std::map<int, DeltaLobe> delta;
    double absent = 0;
    Rng rng(1, stream);
    for (int i = 0; i < samples; ++i) {
        const double u_lobe = rng.uniform(), u1 = rng.uniform(), u2 = rng.uniform();
        const auto s = c.bsdf->sample(c.x, known, u_lobe, {u1, u2}, mode);
        if (!s) {
            ++absent;
        } else if (s->delta) {
            delta[s->lobe].probability = s->pdf;
            ++delta[s->lobe].count;
        } else {
            const std::size_t other = grids[0].contains(s->w) ? 0 : 1;
            ++observed[other * rows * columns + grids[other].cell_of(s->w)];
        }
    }
    double total = 0;
    const auto expect = [&](double probability) {
        total += probability;
        expected.push_back(samples * probability);
    };
    for (std::size_t i = 0; i < 2 * rows * columns; ++i) {
        const std::size_t cell = i % (rows * columns);
        expect(grids[i / (rows * columns)].probability(cell / columns, cell % columns, observed[i]));
    }
    for (const auto& [lobe, d] : delta) {
        expect(d.probability);
        observed.push_back(d.count);
    }
    if (total > 1 + 1e-3) {  // the errors of the cells' integrals where densities end abruptly at the horizon
        message = "probabilities sum to " + std::to_string(total);
        return 0;
    }
    // Less than 1e-4 is the error of the integrals, not absence.
    expect(1 - total > 1e-4 ? 1 - total : absent / samples < 1e-4 ? absent / samples : 0);
    observed.push_back(absent);
    message = std::to_string(total) + " of the probability accounted for, " + std::to_string(absent / samples) +
              " of the samples absent";
    return chi_square_p_value(expected, observed);
}

}  // namespace

double bsdf_test_level() { return sidak_level(1e-3, 4000); }

testing::AssertionResult sampling_follows_pdf(const BsdfCase& c) {
    std::uint64_t stream = 0;
    for (const Vec3& known : known_directions())
        for (const Mode mode : {Mode::eye, Mode::light}) {
            std::string message;
            const double p = p_value(c, known, mode, ++stream, message);
            if (!(p > bsdf_test_level()))
                return testing::AssertionFailure()
                       << c.name << ": p-value " << p << " for w = (" << known.transpose() << "), "
                       << (mode == Mode::eye ? "eye" : "light") << " known; " << message;
        }
    return testing::AssertionSuccess();
}

}  // namespace keyhole
