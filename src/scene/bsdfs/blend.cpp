#include <algorithm>

#include "scene/bsdfs.h"
#include "scene/bsdfs/lobe_choice.h"

namespace keyhole {
namespace {

// (1 - t) first + t second, t clamped to [0, 1]. The lobes of `second` follow those of `first`.
class Blend final : public Bsdf {
  public:
    Blend(BsdfPtr first, BsdfPtr second, ScalarInput weight)
        : first_(std::move(first)), second_(std::move(second)), weight_(std::move(weight)) {
        traits_ = joined(first_->traits(), second_->traits());
        traits_.lobes = add_lobes(first_->traits().lobes, second_->traits().lobes);
        traits_.needs_uv |= weight_.texture != nullptr;
        traits_.chooses_lobe |= weight_.texture || (weight_.constant > 0 && weight_.constant < 1);
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        const double t = weight_at(x);
        const BsdfValue a = first_->eval(x, w_eye, w_light), b = second_->eval(x, w_eye, w_light);
        return {(1 - t) * a.f + t * b.f, (1 - t) * a.pdf_light + t * b.pdf_light, (1 - t) * a.pdf_eye + t * b.pdf_eye};
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode mode) const override {
        const double t = weight_at(x), border = 1 - t;
        const bool takes_first = u_lobe < border;
        const Bsdf& chosen = takes_first ? *first_ : *second_;
        const double u_nested =
            takes_first ? position_in_interval(u_lobe, 0, border) : position_in_interval(u_lobe, border, 1);
        auto s = chosen.sample(x, w_known, u_nested, u, mode);
        if (!s) return s;
        if (!takes_first) s->lobe = static_cast<std::uint8_t>(s->lobe + first_->traits().lobes);
        const double p = takes_first ? 1 - t : t;
        if (s->delta) {
            s->pdf *= p;
            s->pdf_reverse *= p;
            return s;
        }
        add_other(*s, x, w_known, takes_first ? *second_ : *first_, p, mode);
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode mode) const override {
        const double t = weight_at(x), border = 1 - t;
        BsdfEvent nested = event;
        InverseNumbers numbers = v;
        bool takes_first;
        if (event.delta) {
            takes_first = event.lobe < first_->traits().lobes;
            if (!takes_first) nested.lobe = static_cast<std::uint8_t>(event.lobe - first_->traits().lobes);
            if (!((takes_first ? border : t) > 0)) return std::nullopt;
        } else {
            const double first = border * pdf(*first_, x, w_known, w, mode),
                         second = t * pdf(*second_, x, w_known, w, mode);
            if (!(first + second > 0)) return std::nullopt;
            const double p = share(first, second);
            takes_first = v.branch < p;
            numbers.branch = takes_first ? position_in_interval(v.branch, 0, p) : position_in_interval(v.branch, p, 1);
        }
        auto n = (takes_first ? *first_ : *second_).invert(x, w_known, w, nested, numbers, mode);
        if (n) n->lobe = lobe_number(takes_first, border, n->lobe);
        return n;
    }

    const char* name() const override { return "blendbsdf"; }

  private:
    static double pdf(const Bsdf& bsdf, const SurfacePoint& x, const Vec3& w_known, const Vec3& w, Mode mode) {
        return mode == Mode::eye ? bsdf.eval(x, w_known, w).pdf_light : bsdf.eval(x, w, w_known).pdf_eye;
    }

    // Turns the smooth sample of a BSDF of probability p into one of its mixture with `other`.
    static void add_other(BsdfSample& s, const SurfacePoint& x, const Vec3& w_known, const Bsdf& other, double p,
                          Mode mode) {
        const bool eye = mode == Mode::eye;
        const BsdfValue v = eye ? other.eval(x, w_known, s.w) : other.eval(x, s.w, w_known);
        const double pdf = p * s.pdf + (1 - p) * (eye ? v.pdf_light : v.pdf_eye);
        s.weight = (p * s.pdf * s.weight + (1 - p) * abs_cos_theta(s.w) * v.f) / pdf;
        s.pdf = pdf;
        s.pdf_reverse = p * s.pdf_reverse + (1 - p) * (eye ? v.pdf_eye : v.pdf_light);
    }

    double weight_at(const SurfacePoint& x) const { return std::clamp(weight_(x.uv), 0.0, 1.0); }

    BsdfPtr first_, second_;
    ScalarInput weight_;
};

}  // namespace

BsdfPtr make_blend(BsdfPtr first, BsdfPtr second, ScalarInput weight) {
    return std::make_shared<Blend>(std::move(first), std::move(second), std::move(weight));
}

}  // namespace keyhole
