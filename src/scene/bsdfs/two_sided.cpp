#include <algorithm>
#include <stdexcept>

#include "scene/bsdfs/diffuse.h"
#include "scene/bsdfs/lobe_choice.h"

namespace keyhole {
namespace {

// The mirror image in the surface: what happens on the -z side, seen as if it happened on the +z side.
Vec3 flipped(const Vec3& w) { return {w.x(), w.y(), -w.z()}; }

// One opaque BSDF on each side; the one on the back sees flipped directions.
class TwoSided final : public Bsdf {
  public:
    TwoSided(BsdfPtr front, BsdfPtr back) : front_(std::move(front)), back_(std::move(back)) {
        if (front_->traits().transmissive || back_->traits().transmissive)
            throw std::invalid_argument("twosided takes only BSDFs that transmit no light");
        traits_ = joined(front_->traits(), back_->traits());
        traits_.lobes = std::max(front_->traits().lobes, back_->traits().lobes);  // the side tells them apart
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (w_eye.z() > 0) return front_->eval(x, w_eye, w_light);
        return back_->eval(x, flipped(w_eye), flipped(w_light));
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode mode) const override {
        if (w_known.z() > 0) return front_->sample(x, w_known, u_lobe, u, mode);
        auto s = back_->sample(x, flipped(w_known), u_lobe, u, mode);
        if (s) s->w = flipped(s->w);
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode mode) const override {
        if (w_known.z() > 0) return front_->invert(x, w_known, w, event, v, mode);
        return back_->invert(x, flipped(w_known), flipped(w), event, v, mode);
    }

    const char* name() const override { return "twosided"; }

  private:
    BsdfPtr front_, back_;
};

}  // namespace

BsdfPtr make_two_sided(BsdfPtr front, BsdfPtr back) {
    if (front == back)
        if (BsdfPtr diffuse = diffuse_on_both_sides(*front)) return diffuse;
    return std::make_shared<TwoSided>(std::move(front), std::move(back));
}

}  // namespace keyhole
