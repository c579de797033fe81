// Diffuse emission from a surface (Mitsuba's `area`).
#include "base/frame.h"
#include "base/warp.h"
#include "scene/emitters.h"
#include "scene/shape.h"

namespace keyhole {
namespace {

struct ConstantRadiance {
    Spectrum value;
    const Spectrum& operator()(const Vec2&) const { return value; }
    const Spectrum& mean() const { return value; }
};

struct TexturedRadiance {
    std::shared_ptr<const Texture> texture;
    Spectrum operator()(const Vec2& uv) const { return texture->eval(uv); }
    Spectrum mean() const { return texture->mean(); }
};

template <class Radiance>
class AreaEmitter final : public Emitter {
  public:
    AreaEmitter(const Shape& shape, Radiance radiance)
        : shape_(shape),
          origin_rounding_(origin_rounding(shape.origin)),
          area_(shape.area()),
          pdf_area_(1 / area_),
          radiance_(std::move(radiance)) {
        traits_.surface = true;
    }

    EmitterPoint sample_point(double u_part, const Vec2& u) const override {
        const ShapeSample s = shape_.sample(u_part, u);
        return {s.p + shape_.origin, s.ng,       s.uv, pdf_area_, s.offset + origin_rounding_,
                s.offset_per_length, s.primitive};
    }
    std::optional<EmitterNumbers> invert_point(const EmitterPoint& e, const InverseNumbers& v) const override {
        return shape_.invert_sample(e.primitive, e.p - shape_.origin, v);
    }
    double pdf_point(const EmitterPoint&) const override { return pdf_area_; }

    EmissionRay sample_ray(const EmitterPoint& e, const Vec2& u) const override {
        const Vec3 w = square_to_cosine_hemisphere(u);
        return {e.p, Frame::from_normal(e.ng).to_world(w), square_to_cosine_hemisphere_pdf(w)};
    }
    std::optional<Vec2> invert_ray(const EmitterPoint& e, const Vec3& x) const override {
        const Vec3 w = Frame::from_normal(e.ng).to_local((x - e.p).normalized());
        if (!(w.z() > 0)) return std::nullopt;
        return cosine_hemisphere_to_square(w);
    }
    double pdf_ray(const EmitterPoint& e, const Vec3& w) const override {
        const double cosine = e.ng.dot(w);
        return cosine <= 0 ? 0 : cosine * inv_pi;
    }

    Spectrum emitted(const EmitterPoint& e, const Vec3& w) const override {
        const double cosine = e.ng.dot(w);
        if (cosine <= 0) return Spectrum::Zero();
        return radiance_(e.uv) * cosine;
    }
    Spectrum radiance(const EmitterPoint& e, const Vec3& w) const override {
        if (e.ng.dot(w) <= 0) return Spectrum::Zero();
        return radiance_(e.uv);
    }

    // With a texture: as if the surface's parameters covered the texture evenly.
    Spectrum power() const override { return radiance_.mean() * (pi * area_); }

    const char* name() const override { return "area"; }

  private:
    const Shape& shape_;
    float origin_rounding_;
    double area_, pdf_area_;
    Radiance radiance_;
};

}  // namespace

std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, ColorInput radiance) {
    if (radiance.texture)
        return std::make_unique<AreaEmitter<TexturedRadiance>>(shape, TexturedRadiance{std::move(radiance.texture)});
    return std::make_unique<AreaEmitter<ConstantRadiance>>(shape, ConstantRadiance{radiance.constant});
}

}  // namespace keyhole
