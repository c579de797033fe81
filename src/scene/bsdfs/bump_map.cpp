#include "scene/bsdfs.h"
#include "scene/texture.h"

namespace keyhole {
namespace {

// The nested BSDF in the frame of a surface displaced by `scale` times the texture's luminance [Blinn 1978].
//
// f is such that f |cos(w_light)| here equals nested f |cos(w_light)| in the displaced frame. Directions that lie on
// different sides of the two surfaces scatter nothing. f is one number for both ends, and therefore not reciprocal.
class BumpMap final : public Bsdf {
  public:
    BumpMap(BsdfPtr nested, std::shared_ptr<const Texture> displacement, double scale)
        : nested_(std::move(nested)), displacement_(std::move(displacement)), scale_(scale) {
        traits_ = nested_->traits();
        traits_.needs_uv = traits_.needs_tangents = true;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        const Frame frame = displaced_frame(x);
        const Vec3 eye = frame.to_local(w_eye), light = frame.to_local(w_light);
        if (!same_side(eye, w_eye) || !same_side(light, w_light)) return {Spectrum::Zero(), 0, 0};
        BsdfValue v = nested_->eval(x, eye, light);
        v.f *= light.z() / w_light.z();
        return v;
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode mode) const override {
        const Frame frame = displaced_frame(x);
        const Vec3 known = frame.to_local(w_known);
        if (!same_side(known, w_known)) return std::nullopt;
        auto s = nested_->sample(x, known, u_lobe, u, mode);
        if (!s) return s;
        const Vec3 nested_w = s->w;
        s->w = frame.to_world(nested_w);
        if (!same_side(nested_w, s->w)) return std::nullopt;
        // With w_light sampled, the two cosines of w_light cancel; with w_eye sampled, the weight's cosine is the
        // eye's, while f has the ratio of the light's. The same holds for delta lobes, whose f carries 1 /
        // |cos(w_light)|.
        if (mode == Mode::light) s->weight *= known.z() / w_known.z() * (s->w.z() / nested_w.z());
        return s;
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode mode) const override {
        const Frame frame = displaced_frame(x);
        const Vec3 known = frame.to_local(w_known), nested_w = frame.to_local(w);
        if (!same_side(known, w_known) || !same_side(nested_w, w)) return std::nullopt;
        return nested_->invert(x, known, nested_w, event, v, mode);
    }

    const char* name() const override { return "bumpmap"; }

  private:
    static bool same_side(const Vec3& a, const Vec3& b) { return a.z() * b.z() > 0; }

    // Frame of dp/du + dh/du n and dp/dv + dh/dv n in local coordinates; the undisplaced one where uv is degenerate.
    Frame displaced_frame(const SurfacePoint& x) const {
        const Vec2 slope = scale_ * displacement_->gradient(x.uv);
        const Vec3 dp_du(x.du_s, 0, slope.x()), dp_dv(x.dv_s, x.dv_t, slope.y());
        const Vec3 normal = dp_du.cross(dp_dv);
        if (!(normal.z() != 0)) return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
        return Frame::from_normal_and_tangent(normal / std::copysign(normal.norm(), normal.z()), dp_du);
    }

    BsdfPtr nested_;
    std::shared_ptr<const Texture> displacement_;
    double scale_;
};

}  // namespace

BsdfPtr make_bump_map(BsdfPtr nested, std::shared_ptr<const Texture> displacement, double scale) {
    return std::make_shared<BumpMap>(std::move(nested), std::move(displacement), scale);
}

}  // namespace keyhole
