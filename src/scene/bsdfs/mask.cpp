#include <algorithm>

#include "scene/bsdfs.h"
#include "scene/bsdfs/lobe_choice.h"

namespace keyhole {
namespace {

// A surface with holes: light passes unhindered with probability 1 - opacity (lobe 0), else meets the nested BSDF
// (its lobes, from 1). Opacity is clamped to [0, 1].
class Mask final : public Bsdf {
  public:
    Mask(BsdfPtr nested, ScalarInput opacity) : nested_(std::move(nested)), opacity_(std::move(opacity)) {
        traits_ = nested_->traits();
        traits_.lobes = add_lobes(1, nested_->traits().lobes);
        traits_.needs_uv |= opacity_.texture != nullptr;
        if (opacity_.texture || opacity_.constant < 1)
            traits_.delta = traits_.transmissive = traits_.chooses_lobe = true;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        const double opacity = opacity_at(x);
        BsdfValue v = nested_->eval(x, w_eye, w_light);
        v.f *= opacity;
        v.pdf_light *= opacity;
        v.pdf_eye *= opacity;
        return v;
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode mode) const override {
        const double opacity = opacity_at(x), transparency = 1 - opacity;
        if (u_lobe < transparency)
            return BsdfSample{-w_known, Spectrum::Ones(), transparency, transparency, 1, 0, true};
        auto s = nested_->sample(x, w_known, position_in_interval(u_lobe, transparency, 1), u, mode);
        if (!s) return s;
        s->pdf *= opacity;
        s->pdf_reverse *= opacity;
        s->lobe += 1;
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode mode) const override {
        const double opacity = opacity_at(x), transparency = 1 - opacity;
        if (event.delta && event.lobe == 0) {
            if (!(transparency > 0)) return std::nullopt;
            return BsdfNumbers{number_in_interval(v.place, 0, transparency), v.direction};
        }
        if (!(opacity > 0)) return std::nullopt;
        BsdfEvent nested = event;
        if (event.delta) --nested.lobe;
        auto n = nested_->invert(x, w_known, w, nested, v, mode);
        if (n) n->lobe = number_in_interval(n->lobe, transparency, 1);
        return n;
    }

    const char* name() const override { return "mask"; }

  private:
    double opacity_at(const SurfacePoint& x) const { return std::clamp(opacity_(x.uv), 0.0, 1.0); }

    BsdfPtr nested_;
    ScalarInput opacity_;
};

}  // namespace

BsdfPtr make_mask(BsdfPtr nested, ScalarInput opacity) {
    return std::make_shared<Mask>(std::move(nested), std::move(opacity));
}

}  // namespace keyhole
