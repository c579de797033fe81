// inverse_gives_the_sample and inverse_numbers_are_uniform: `invert` against `sample`.
#include <array>

#include "base/rng.h"
#include "base/warp.h"
#include "bsdf_harness.h"
#include "statistics.h"

namespace keyhole {
namespace {

struct Draw {
    BsdfNumbers numbers;
    BsdfSample sample;
};

BsdfNumbers uniform_numbers(Rng& rng) {
    BsdfNumbers n;
    n.lobe = rng.uniform();
    n.direction.x() = rng.uniform();
    n.direction.y() = rng.uniform();
    return n;
}

// Uniform numbers that give a sample; empty if there is none among many.
std::optional<Draw> draw(const BsdfCase& c, const Vec3& known, Mode mode, Rng& rng) {
    for (int i = 0; i < 200; ++i) {
        const BsdfNumbers n = uniform_numbers(rng);
        if (const auto s = c.bsdf->sample(c.x, known, n.lobe, n.direction, mode)) return Draw{n, *s};
    }
    return std::nullopt;
}

// In 4 x 5 x 5 cells of the cube of numbers.
class Histogram {
  public:
    void add(const BsdfNumbers& n) {
        const auto cell = [](double u, int cells) { return static_cast<int>(u * cells); };
        ++counts_[static_cast<std::size_t>((cell(n.lobe, 4) * 5 + cell(n.direction.x(), 5)) * 5 +
                                           cell(n.direction.y(), 5))];
    }

    // Of the hypothesis that two histograms of equally many numbers have one distribution. Cells of less than ten
    // numbers in all are left out.
    static double p_value(const Histogram& a, const Histogram& b) {
        double chi_square = 0, cells = 0;
        for (std::size_t i = 0; i < a.counts_.size(); ++i) {
            const double sum = a.counts_[i] + b.counts_[i], difference = a.counts_[i] - b.counts_[i];
            if (sum < 10) continue;
            chi_square += difference * difference / sum;
            ++cells;
        }
        return cells > 1 ? chi_square_tail(chi_square, cells - 1) : 1;
    }

  private:
    std::array<double, 100> counts_{};
};

testing::AssertionResult failure(const Vec3& known, Mode mode) {
    return testing::AssertionFailure() << "known direction (" << known.transpose() << "), "
                                       << (mode == Mode::eye ? "eye" : "light") << ": ";
}

template <class Check>
testing::AssertionResult for_all(const Check& check) {
    std::uint64_t stream = 0;
    for (const Vec3& known : known_directions())
        for (const Mode mode : {Mode::eye, Mode::light})
            if (auto result = check(known, mode, Rng(2, stream++)); !result) return result;
    return testing::AssertionSuccess();
}

}  // namespace

testing::AssertionResult inverse_gives_the_sample(const BsdfCase& c) {
    return for_all([&](const Vec3& known, Mode mode, Rng rng) -> testing::AssertionResult {
        for (int i = 0; i < 2000; ++i) {
            const auto d = draw(c, known, mode, rng);
            if (!d) break;
            const BsdfSample& s = d->sample;
            const auto n = c.bsdf->invert(c.x, known, s.w, {s.delta, s.lobe}, fresh_numbers(rng), mode);
            if (!n) return failure(known, mode) << "no inverse of (" << s.w.transpose() << ")";
            for (const double u : {n->lobe, n->direction.x(), n->direction.y()})
                if (!(u >= 0 && u < 1)) return failure(known, mode) << "the number " << u;
            const auto again = c.bsdf->sample(c.x, known, n->lobe, n->direction, mode);
            if (!again) return failure(known, mode) << "no sample from the inverse of (" << s.w.transpose() << ")";
            if (again->delta != s.delta || (s.delta && again->lobe != s.lobe))
                return failure(known, mode) << "another lobe: " << int{again->lobe} << ", not " << int{s.lobe};
            // A lobe's width is about 1 / sqrt(density).
            const double error = (again->w - s.w).norm() * (s.delta ? 1 : std::sqrt(std::max(1.0, s.pdf)));
            if (!(error < 1e-7))
                return failure(known, mode) << "(" << s.w.transpose() << ") comes back as (" << again->w.transpose()
                                            << "), off by " << error << " of the lobe's width";
            if (std::abs(again->pdf - s.pdf) > 1e-5 * s.pdf)
                return failure(known, mode) << "the density " << s.pdf << " comes back as " << again->pdf;
        }
        return testing::AssertionSuccess();
    });
}

testing::AssertionResult inverse_numbers_are_uniform(const BsdfCase& c) {
    constexpr int draws = 10000;
    return for_all([&](const Vec3& known, Mode mode, Rng rng) -> testing::AssertionResult {
        Histogram numbers, inverted;
        for (int i = 0; i < draws; ++i) {
            const auto one = draw(c, known, mode, rng), other = draw(c, known, mode, rng);
            if (!one || !other) return testing::AssertionSuccess();
            numbers.add(one->numbers);
            const BsdfSample& s = other->sample;
            const auto n = c.bsdf->invert(c.x, known, s.w, {s.delta, s.lobe}, fresh_numbers(rng), mode);
            if (!n) return failure(known, mode) << "no inverse of (" << s.w.transpose() << ")";
            inverted.add(*n);
        }
        const double p = Histogram::p_value(numbers, inverted);
        if (p < bsdf_test_level()) return failure(known, mode) << "p = " << p;
        return testing::AssertionSuccess();
    });
}

testing::AssertionResult inverts_any_direction(const BsdfCase& c) {
    return for_all([&](const Vec3& known, Mode mode, Rng rng) -> testing::AssertionResult {
        std::vector<Vec3> directions = known_directions();
        for (const double side : {1.0, -1.0}) directions.emplace_back(-known.x(), -known.y(), side * known.z());
        directions.emplace_back(known);
        for (int i = 0; i < 400; ++i) {
            const double u = rng.uniform();
            directions.push_back(square_to_sphere({u, rng.uniform()}));
        }
        int failed = 0;
        for (const Vec3& w : directions) {
            const BsdfValue value = mode == Mode::eye ? c.bsdf->eval(c.x, known, w) : c.bsdf->eval(c.x, w, known);
            const double pdf = mode == Mode::eye ? value.pdf_light : value.pdf_eye;
            const auto n = c.bsdf->invert(c.x, known, w, {}, fresh_numbers(rng), mode);
            if (!(pdf > 0)) {
                if (n) return failure(known, mode) << "an inverse of (" << w.transpose() << "), of density zero";
                continue;
            }
            if (!n) {
                failed += pdf > 1e-8;
                continue;
            }
            for (const double u : {n->lobe, n->direction.x(), n->direction.y()})
                if (!(u >= 0 && u < 1)) return failure(known, mode) << "the number " << u;
            const auto again = c.bsdf->sample(c.x, known, n->lobe, n->direction, mode);
            if (again && again->delta) return failure(known, mode) << "a delta lobe for (" << w.transpose() << ")";
            // Of a density below 1e-8, far in the tail, there may be no numbers left between a value and one.
            const double error = again ? (again->w - w).norm() * std::sqrt(std::max(1.0, pdf)) : 1e300;
            if (!(error < 1e-6) && pdf > 1e-8) ++failed;
        }
        if (failed > 0) return failure(known, mode) << failed << " directions do not come back";
        return testing::AssertionSuccess();
    });
}

testing::AssertionResult inverse_survives_borders(const BsdfCase& c) {
    const std::array numbers = {0.0, 0x1p-53, 0.25, 0.5, one_minus_epsilon};
    return for_all([&](const Vec3& known, Mode mode, Rng) -> testing::AssertionResult {
        for (const double u_lobe : numbers)
            for (const double u1 : numbers)
                for (const double u2 : numbers)
                    for (const double v : {0.0, one_minus_epsilon}) {
                        const auto s = c.bsdf->sample(c.x, known, u_lobe, {u1, u2}, mode);
                        if (!s) continue;
                        const auto n = c.bsdf->invert(c.x, known, s->w, {s->delta, s->lobe}, {v, v, {v, v}}, mode);
                        if (!n) continue;
                        for (const double u : {n->lobe, n->direction.x(), n->direction.y()})
                            if (!(u >= 0 && u < 1))
                                return failure(known, mode) << "the number " << u << " of the sample of (" << u_lobe
                                                            << ", " << u1 << ", " << u2 << ")";
                    }
        return testing::AssertionSuccess();
    });
}

}  // namespace keyhole
