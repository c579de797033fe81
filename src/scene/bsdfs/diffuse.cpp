#include "base/warp.h"
#include "scene/bsdfs.h"

namespace keyhole {
namespace {

// Lambertian reflection on the +z side.
class Diffuse final : public Bsdf {
  public:
    explicit Diffuse(ColorInput reflectance)
        : reflectance_(std::move(reflectance)), constant_f_(reflectance_.constant * inv_pi) {
        traits_.smooth = reflectance_.texture || !is_black(reflectance_.constant);
        traits_.needs_uv = reflectance_.texture != nullptr;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (!(w_eye.z() > 0 && w_light.z() > 0 && traits_.smooth)) return {Spectrum::Zero(), 0, 0};
        const double pdf_light = w_light.z() * inv_pi, pdf_eye = w_eye.z() * inv_pi;
        if (!reflectance_.texture) return {constant_f_, pdf_light, pdf_eye};
        return {reflectance_.texture->eval(x.uv) * inv_pi, pdf_light, pdf_eye};
    }

    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double, const Vec2& u,
                                     Mode) const override {
        if (!(w_known.z() > 0 && traits_.smooth)) return std::nullopt;
        const Vec3 w = square_to_cosine_hemisphere(u);
        if (!(w.z() > 0)) return std::nullopt;
        return BsdfSample{w, reflectance_(x.uv), w.z() * inv_pi, w_known.z() * inv_pi};
    }

    const char* name() const override { return "diffuse"; }

  private:
    ColorInput reflectance_;
    Spectrum constant_f_;
};

}  // namespace

BsdfPtr make_diffuse(ColorInput reflectance) { return std::make_shared<Diffuse>(std::move(reflectance)); }

}  // namespace keyhole
