// A point that emits into a cone (Mitsuba's `spot`, without texture).
#include <cmath>
#include <stdexcept>

#include "base/frame.h"
#include "base/warp.h"
#include "scene/emitters.h"
#include "scene/emitters/delta_position.h"

namespace keyhole {
namespace {

class SpotEmitter final : public DeltaPositionEmitter {
  public:
    // Angles in radians, 0 <= beam <= cutoff <= pi, 0 < cutoff.
    SpotEmitter(const Vec3& position, const Vec3& axis, const Spectrum& intensity, double cutoff, double beam)
        : DeltaPositionEmitter(position),
          frame_(Frame::from_normal(axis)),
          intensity_(intensity),
          cutoff_(cutoff),
          beam_(beam),
          cos_cutoff_(std::cos(cutoff)),
          cos_beam_(std::cos(beam)) {}

    EmissionRay sample_ray(const EmitterPoint& e, const Vec2& u) const override {
        return {e.p, frame_.to_world(square_to_cone(u, cos_cutoff_)), square_to_cone_pdf(cos_cutoff_)};
    }
    std::optional<Vec2> invert_ray(const EmitterPoint& e, const Vec3& x) const override {
        const Vec3 w = (x - e.p).normalized();
        if (!(pdf_ray(e, w) > 0)) return std::nullopt;
        return cone_to_square(frame_.to_local(w), cos_cutoff_);
    }
    double pdf_ray(const EmitterPoint&, const Vec3& w) const override {
        // Rounding may put a sampled direction just outside the cone.
        return frame_.n.dot(w) < cos_cutoff_ - 1e-15 ? 0 : square_to_cone_pdf(cos_cutoff_);
    }
    Spectrum emitted(const EmitterPoint&, const Vec3& w) const override {
        return intensity_ * falloff(frame_.n.dot(w));
    }

    // 2 pi times the integral of falloff * sin = 2 pi (1 - (sin c - sin b) / (c - b)) = 2 pi (1 - cos(m) sin(h) / h)
    // with m and h the mean and half the difference of the two angles; in a form that keeps its digits.
    Spectrum power() const override {
        const double m = (cutoff_ + beam_) / 2, h = (cutoff_ - beam_) / 2;
        const double one_minus_sinc = h < 1e-3 ? h * h / 6 : 1 - std::sin(h) / h;
        return intensity_ * (2 * pi * (2 * sqr(std::sin(m / 2)) + std::cos(m) * one_minus_sinc));
    }
    const char* name() const override { return "spot"; }

  private:
    double falloff(double cosine) const {
        if (cosine <= cos_cutoff_) return 0;
        if (cosine >= cos_beam_) return 1;
        return (cutoff_ - std::acos(cosine)) / (cutoff_ - beam_);
    }

    Frame frame_;
    Spectrum intensity_;
    double cutoff_, beam_, cos_cutoff_, cos_beam_;
};

}  // namespace

std::unique_ptr<Emitter> make_spot_emitter(const Affine& to_world, const Spectrum& intensity, double cutoff_angle,
                                           double beam_width) {
    if (!(cutoff_angle > 0 && cutoff_angle <= 180))
        throw std::invalid_argument("cutoff_angle must lie between 0 and 180 degrees");
    if (!(beam_width >= 0 && beam_width <= cutoff_angle))
        throw std::invalid_argument("beam_width must lie between 0 and cutoff_angle");
    const Vec3 axis = to_world.linear().col(2);
    if (!to_world.matrix().allFinite() || !(axis.norm() > 0))
        throw std::invalid_argument("to_world of the emitter is singular");
    return std::make_unique<SpotEmitter>(to_world.translation(), axis.normalized(), intensity, cutoff_angle * pi / 180,
                                         beam_width * pi / 180);
}

}  // namespace keyhole
