// The checks of bsdf_harness.h that look at single samples, and the mean weights.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/rng.h"
#include "base/warp.h"
#include "bsdf_harness.h"

namespace keyhole {
namespace {

constexpr std::array modes = {Mode::eye, Mode::light};

bool near(double a, double b, double relative = 1e-9) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}
bool near(const Spectrum& a, const Spectrum& b) { return near(a[0], b[0]) && near(a[1], b[1]) && near(a[2], b[2]); }

BsdfValue eval(const BsdfCase& c, const Vec3& known, const Vec3& w, Mode mode) {
    return mode == Mode::eye ? c.bsdf->eval(c.x, known, w) : c.bsdf->eval(c.x, w, known);
}

Mode opposite(Mode mode) { return mode == Mode::eye ? Mode::light : Mode::eye; }

Vec2 uniform2(Rng& rng) {
    const double first = rng.uniform();
    return {first, rng.uniform()};
}

// Uniform on the sphere, every fourth one within a few degrees of the horizon.
Vec3 random_direction(Rng& rng) {
    Vec3 w = square_to_sphere(uniform2(rng));
    if (rng.below(4) == 0) w.z() *= 0.01;
    return w.normalized();
}

testing::AssertionResult failure(const BsdfCase& c, const Vec3& known, Mode mode) {
    return testing::AssertionFailure() << c.name << ", w = (" << known.transpose() << ") "
                                       << (mode == Mode::eye ? "eye" : "light") << " known: ";
}

class ConstantTexture final : public Texture {
  public:
    ConstantTexture(const Spectrum& color, const Vec2& slope) : color_(color), slope_(slope) {}
    Spectrum eval(const Vec2&) const override { return color_; }
    Vec2 gradient(const Vec2&) const override { return slope_; }
    Spectrum mean() const override { return color_; }
    double maximum() const override { return color_.maxCoeff(); }

  private:
    Spectrum color_;
    Vec2 slope_;
};

// What is wrong with a sample whatever the BSDF; empty if nothing.
std::string defect(const BsdfCase& c, const Vec3& known, const BsdfSample& s) {
    const BsdfTraits& traits = c.bsdf->traits();
    if (!s.w.allFinite() || !near(s.w.norm(), 1, 1e-12)) return "direction is not a unit vector";
    if (s.w.z() == 0 && known.z() != 0) return "exactly grazing direction";
    if (!s.weight.allFinite() || s.weight.minCoeff() < 0) return "weight is negative or not finite";
    if (!(s.pdf > 0) || !std::isfinite(s.pdf)) return "pdf is not positive and finite";
    if (!(s.pdf_reverse >= 0) || !std::isfinite(s.pdf_reverse)) return "pdf_reverse is negative or not finite";
    if (s.delta ? !traits.delta : !traits.smooth) return "the traits have no such kind of lobe";
    if (s.delta && s.pdf > 1) return "probability of a delta lobe exceeds 1";
    if (s.lobe >= traits.lobes) return "lobe index is not below traits().lobes";
    if (s.w.z() * known.z() < 0 && !traits.transmissive) return "transmission by an opaque BSDF";
    if (s.w.z() * known.z() > 0 && s.eta != 1) return "reflection with eta different from 1";
    const double refraction = known.z() > 0 ? c.eta : 1 / c.eta;
    if (s.eta != 1 && !near(s.eta, refraction)) return "eta is not the case's";
    return {};
}

}  // namespace

SurfacePoint flat_point() {
    SurfacePoint x;
    x.p = Vec3::Zero();
    x.ng = Vec3::UnitZ();
    x.frame = Frame::from_normal(x.ng);
    x.uv = {0.3, 0.6};
    x.du_s = 2;
    x.dv_s = 0.5;
    x.dv_t = 1.5;
    return x;
}

std::shared_ptr<const Texture> constant_texture(const Spectrum& color, const Vec2& slope) {
    return std::make_shared<ConstantTexture>(color, slope);
}

std::vector<Vec3> known_directions() {
    std::vector<Vec3> directions;
    for (const double side : {1.0, -1.0}) {
        directions.push_back({0, 0, side});
        for (const auto& [degrees, phi] : {std::pair(35.0, 0.4), {65.0, 2.9}, {80.0, 4.5}, {89.99, 0.4}}) {
            const double theta = degrees * pi / 180;
            directions.push_back(
                {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), side * std::cos(theta)});
        }
    }
    return directions;
}

testing::AssertionResult sample_agrees_with_eval(const BsdfCase& c) {
    Rng rng(2);
    for (int i = 0; i < 4000; ++i) {
        const Vec3 known = random_direction(rng);
        const Mode mode = modes[i % 2];
        const double u_lobe = rng.uniform();
        const auto s = c.bsdf->sample(c.x, known, u_lobe, uniform2(rng), mode);
        if (!s) continue;
        if (const std::string what = defect(c, known, *s); !what.empty()) return failure(c, known, mode) << what;
        if (s->delta) continue;
        const BsdfValue v = eval(c, known, s->w, mode);
        const double forward = mode == Mode::eye ? v.pdf_light : v.pdf_eye;
        const double reverse = mode == Mode::eye ? v.pdf_eye : v.pdf_light;
        if (!near(s->pdf, forward)) return failure(c, known, mode) << "pdf " << s->pdf << ", eval " << forward;
        if (!near(s->pdf_reverse, reverse))
            return failure(c, known, mode) << "pdf_reverse " << s->pdf_reverse << ", eval " << reverse;
        const Spectrum weight = v.f * std::abs(s->w.z()) / forward;
        if (!near(s->weight, weight))
            return failure(c, known, mode) << "weight " << s->weight.transpose() << ", eval " << weight.transpose();
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult delta_samples_are_reversible(const BsdfCase& c) {
    if (!c.bsdf->traits().delta) return testing::AssertionSuccess();
    Rng rng(3);
    for (int i = 0; i < 400; ++i) {
        const Vec3 known = random_direction(rng);
        const Mode mode = modes[i % 2];
        const double u_lobe = rng.uniform();
        const auto s = c.bsdf->sample(c.x, known, u_lobe, uniform2(rng), mode);
        if (!s || !s->delta || s->pdf_reverse < 0.02) continue;
        std::optional<BsdfSample> back;
        for (int tries = 0; tries < 1000 && !(back && back->delta && back->lobe == s->lobe); ++tries)
            back = c.bsdf->sample(c.x, s->w, rng.uniform(), {0.5, 0.5}, opposite(mode));
        if (!back || back->lobe != s->lobe || !((back->w - known).norm() < 1e-9))
            return failure(c, known, mode) << "the way back is not found";
        if (!near(s->pdf, back->pdf_reverse) || !near(s->pdf_reverse, back->pdf) || !near(s->eta * back->eta, 1))
            return failure(c, known, mode) << "probabilities or indices are not exchanged on the way back";
        // Power form: radiance scaling is in the weights of Mode::eye only.
        const auto coefficient = [](const BsdfSample& sample, Mode m) -> Spectrum {
            return sample.weight * (sample.pdf * (m == Mode::eye ? sqr(sample.eta) : 1));
        };
        if (c.reciprocal && !near(coefficient(*s, mode), coefficient(*back, opposite(mode))))
            return failure(c, known, mode) << "coefficients of the two ways differ";
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult is_reciprocal(const BsdfCase& c) {
    Rng rng(4);
    for (int i = 0; i < 4000; ++i) {
        const Vec3 a = random_direction(rng), b = random_direction(rng);
        const auto scaled = [&](const Vec3& w_eye, const Vec3& w_light) -> Spectrum {
            return c.bsdf->eval(c.x, w_eye, w_light).f / sqr(w_eye.z() > 0 ? 1 : c.eta);
        };
        if (!near(scaled(a, b), scaled(b, a)))
            return failure(c, a, Mode::eye) << "f(a, b) = " << scaled(a, b).transpose()
                                            << ", f(b, a) = " << scaled(b, a).transpose() << ", b = " << b.transpose();
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult conserves_energy(const BsdfCase& c) {
    constexpr int samples = 4000;
    Rng rng(5);
    for (const Vec3& known : known_directions())
        for (const Mode mode : modes) {
            if (mode == Mode::light && !c.reciprocal) continue;  // only the eye's albedo is bounded
            Spectrum sum = Spectrum::Zero(), squares = Spectrum::Zero();
            for (int i = 0; i < samples; ++i) {
                const double u_lobe = rng.uniform();
                const auto s = c.bsdf->sample(c.x, known, u_lobe, uniform2(rng), mode);
                if (!s) continue;
                const Spectrum power = s->weight * (mode == Mode::eye ? sqr(s->eta) : 1);
                sum += power;
                squares += power.square();
            }
            const Spectrum mean = sum / samples;
            const Spectrum error = ((squares / samples - mean.square()).max(0) / samples).sqrt() * 6 + 1e-9;
            const bool lossless = known.z() > 0 ? c.lossless_front : c.lossless_back;
            if ((mean > 1 + error).any() || (lossless && (mean < 1 - error).any()))
                return failure(c, known, mode) << "albedo " << mean.transpose() << " +- " << error.transpose() / 6;
        }
    return testing::AssertionSuccess();
}

testing::AssertionResult survives_extremes(const BsdfCase& c) {
    const std::array numbers = {0.0, 0x1p-53, 0.25, 0.5, 0.75, one_minus_epsilon};
    const std::array grazing = {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.6, 0.8, 0)};
    std::vector<Vec3> directions = known_directions();
    directions.insert(directions.end(), grazing.begin(), grazing.end());
    for (const Vec3& known : directions)
        for (const Mode mode : modes) {
            for (const double u_lobe : numbers)
                for (const double u1 : numbers)
                    for (const double u2 : numbers) {
                        const auto s = c.bsdf->sample(c.x, known, u_lobe, {u1, u2}, mode);
                        if (!s) continue;
                        const std::string what = defect(c, known, *s);
                        if (!what.empty())
                            return failure(c, known, mode) << what << "; u = " << u_lobe << ", " << u1 << ", " << u2;
                    }
            for (const Vec3& w : directions) {
                const BsdfValue v = eval(c, known, w, mode);
                const bool zero = v.pdf_light == 0 && v.pdf_eye == 0 && (v.f == 0).all();
                const bool grazes = known.z() == 0 || w.z() == 0;
                const bool crosses = known.z() * w.z() < 0 && !c.bsdf->traits().transmissive;
                if ((grazes || crosses || !c.bsdf->traits().smooth) && !zero)
                    return failure(c, known, mode) << "value on the wrong side, w = " << w.transpose();
                if (!v.f.allFinite() || v.f.minCoeff() < 0 || !(v.pdf_light >= 0 && v.pdf_eye >= 0) ||
                    !std::isfinite(v.pdf_light + v.pdf_eye))
                    return failure(c, known, mode) << "eval is negative or not finite, w = " << w.transpose();
            }
        }
    return testing::AssertionSuccess();
}

testing::AssertionResult lobe_number_only_chooses(const BsdfCase& c) {
    Rng rng(6);
    for (int i = 0; i < 4000; ++i) {
        const Vec3 known = random_direction(rng);
        const Mode mode = modes[i % 2];
        const Vec2 u = uniform2(rng);
        const auto a = c.bsdf->sample(c.x, known, rng.uniform(), u, mode);
        const auto b = c.bsdf->sample(c.x, known, rng.uniform(), u, mode);
        if (!c.bsdf->traits().chooses_lobe && (a.has_value() != b.has_value() || (a && a->lobe != b->lobe)))
            return failure(c, known, mode) << "the lobe number has an effect that the traits deny";
        if (a && b && a->lobe == b->lobe && a->w != b->w)
            return failure(c, known, mode) << "the lobe number moves the direction";
    }
    return testing::AssertionSuccess();
}

}  // namespace keyhole
