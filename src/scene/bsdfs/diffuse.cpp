#include "scene/bsdfs/diffuse.h"

#include "base/warp.h"

namespace keyhole {
namespace {

// Lambertian reflection, on the +z side or on both.
class Diffuse final : public Bsdf {
  public:
    Diffuse(ColorInput reflectance, bool two_sided)
        : reflectance_(std::move(reflectance)), constant_f_(reflectance_.constant * inv_pi), two_sided_(two_sided) {
        traits_.smooth = reflectance_.texture || !is_black(reflectance_.constant);
        traits_.needs_uv = reflectance_.texture != nullptr;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        const double side = side_of(w_eye), cos_eye = side * w_eye.z(), cos_light = side * w_light.z();
        if (!(cos_eye > 0 && cos_light > 0 && traits_.smooth)) return {Spectrum::Zero(), 0, 0};
        const double pdf_light = cos_light * inv_pi, pdf_eye = cos_eye * inv_pi;
        if (!reflectance_.texture) return {constant_f_, pdf_light, pdf_eye};
        return {reflectance_.texture->eval(x.uv) * inv_pi, pdf_light, pdf_eye};
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double, const Vec2& u,
                                     Mode) const override {
        const double side = side_of(w_known), cos_known = side * w_known.z();
        if (!(cos_known > 0 && traits_.smooth)) return std::nullopt;
        const Vec3 w = square_to_cosine_hemisphere(u);
        if (!(w.z() > 0)) return std::nullopt;
        return BsdfSample{{w.x(), w.y(), side * w.z()}, reflectance_(x.uv), w.z() * inv_pi, cos_known * inv_pi};
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        const double side = side_of(w_known);
        const Vec3 above(w.x(), w.y(), side * w.z());
        if (event.delta || !(side * w_known.z() > 0 && above.z() > 0 && traits_.smooth)) return std::nullopt;
        return BsdfNumbers{v.place, cosine_hemisphere_to_square(above)};
    }

    const char* name() const override { return two_sided_ ? "twosided" : "diffuse"; }
    BsdfPtr on_both_sides() const { return std::make_shared<Diffuse>(reflectance_, true); }

  private:
    double side_of(const Vec3& w) const { return two_sided_ && w.z() < 0 ? -1 : 1; }

    ColorInput reflectance_;
    Spectrum constant_f_;
    bool two_sided_;
};

}  // namespace

BsdfPtr make_diffuse(ColorInput reflectance) { return std::make_shared<Diffuse>(std::move(reflectance), false); }

BsdfPtr diffuse_on_both_sides(const Bsdf& bsdf) {
    const auto* diffuse = dynamic_cast<const Diffuse*>(&bsdf);
    return diffuse ? diffuse->on_both_sides() : nullptr;
}

}  // namespace keyhole
