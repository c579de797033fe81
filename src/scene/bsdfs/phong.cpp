#include "base/warp.h"
#include "scene/bsdfs.h"
#include "scene/bsdfs/lobe_choice.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

// Modified Phong model on the +z side [Lafortune and Willems 1994]: f = k_d / pi + k_s (n + 2) / (2 pi) cos^n(alpha),
// alpha measured from the mirror direction. Conserves energy where k_d + k_s <= 1. Lobe 0 is the specular one.
class Phong final : public Bsdf {
  public:
    Phong(ScalarInput exponent, ColorInput diffuse_reflectance, ColorInput specular_reflectance)
        : exponent_(std::move(exponent)),
          diffuse_(std::move(diffuse_reflectance)),
          specular_(std::move(specular_reflectance)) {
        traits_.smooth = true;
        traits_.chooses_lobe = true;
        traits_.needs_uv = exponent_.texture || diffuse_.texture || specular_.texture;
        traits_.lobes = 2;
    }

    BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const override {
        if (!(w_eye.z() > 0 && w_light.z() > 0)) return {Spectrum::Zero(), 0, 0};
        return value(parameters(x), w_eye, w_light);
    }

    // Directions of the specular lobe below the horizon are no samples.
    std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                     Mode) const override {
        if (!(w_known.z() > 0)) return std::nullopt;
        const Parameters p = parameters(x);
        const std::uint8_t lobe = u_lobe < p.specular_probability ? 0 : 1;
        const Vec3 w = lobe == 0 ? Frame::from_normal(reflect(w_known)).to_world(square_to_cosine_power(u, p.exponent))
                                 : square_to_cosine_hemisphere(u);
        if (!(w.z() > 0)) return std::nullopt;
        const BsdfValue v = value(p, w_known, w);
        if (!(v.pdf_light > 0)) return std::nullopt;
        return BsdfSample{w, v.f * (w.z() / v.pdf_light), v.pdf_light, v.pdf_eye, 1, lobe, false};
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (event.delta || !(w_known.z() > 0 && w.z() > 0)) return std::nullopt;
        const Parameters p = parameters(x);
        const Frame mirror = Frame::from_normal(reflect(w_known));
        const Vec3 about_mirror = mirror.to_local(w);
        const double c = p.specular_probability;
        const double specular = c * square_to_cosine_power_pdf(about_mirror, p.exponent);
        const double diffuse = (1 - c) * square_to_cosine_hemisphere_pdf(w);
        if (!(specular + diffuse > 0)) return std::nullopt;
        const bool mirrors = v.branch < share(specular, diffuse);
        return BsdfNumbers{lobe_number(mirrors, c, v.place),
                           mirrors ? cosine_power_to_square(about_mirror, p.exponent) : cosine_hemisphere_to_square(w)};
    }

    const char* name() const override { return "phong"; }

  private:
    struct Parameters {
        Spectrum diffuse, specular;
        double exponent;
        double specular_probability;  // 0 where both lobes are black
    };

    Parameters parameters(const SurfacePoint& x) const {
        Parameters p{diffuse_(x.uv), specular_(x.uv), exponent_(x.uv), 0};
        const double specular = luminance(p.specular);
        if (specular > 0) p.specular_probability = share(specular, luminance(p.diffuse));
        return p;
    }

    static BsdfValue value(const Parameters& p, const Vec3& w_eye, const Vec3& w_light) {
        const double cos_alpha = reflect(w_eye).dot(w_light);
        const double lobe = cos_alpha > 0 ? std::pow(cos_alpha, p.exponent) * (0.5 * inv_pi) : 0;
        const double specular_pdf = p.specular_probability * (p.exponent + 1) * lobe;
        const double diffuse_pdf = (1 - p.specular_probability) * inv_pi;
        return {p.diffuse * inv_pi + p.specular * ((p.exponent + 2) * lobe), specular_pdf + diffuse_pdf * w_light.z(),
                specular_pdf + diffuse_pdf * w_eye.z()};
    }

    ScalarInput exponent_;
    ColorInput diffuse_, specular_;
};

}  // namespace

BsdfPtr make_phong(ScalarInput exponent, ColorInput diffuse_reflectance, ColorInput specular_reflectance) {
    return std::make_shared<Phong>(std::move(exponent), std::move(diffuse_reflectance),
                                   std::move(specular_reflectance));
}

}  // namespace keyhole
