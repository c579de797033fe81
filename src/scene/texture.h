// Textures: functions of the surface parameters (u, v), and inputs that are either a constant or a texture.
#pragma once

#include <memory>
#include <string>

#include "base/spectrum.h"
#include "base/vec.h"

namespace keyhole {

class Texture {
  public:
    virtual ~Texture() = default;
    virtual Spectrum eval(const Vec2& uv) const = 0;
    // Partial derivatives of the luminance with respect to u and v (bump maps); of the bilinear interpolant of a
    // bitmap, whatever its filter.
    virtual Vec2 gradient(const Vec2& uv) const = 0;
    // Average over one period, for light selection and reports.
    virtual Spectrum mean() const = 0;
    // Largest value of any channel.
    virtual double maximum() const = 0;
    virtual std::size_t bytes() const { return sizeof(*this); }
};

enum class TextureFilter { nearest, bilinear };
enum class TextureWrap { repeat, mirror, clamp };

// Lookups are at to_uv (u, 1 - v), a 2-D affine map in homogeneous form, with y = 0 the top of the image: v = 0 is its
// bottom, and the order is Mitsuba's, whose OBJ reader flips v.
struct BitmapParams {
    std::string filename;  // any file OpenImageIO reads; alpha is ignored
    bool raw = false;      // true: values are linear already; false: files of integers are decoded from sRGB
    TextureFilter filter = TextureFilter::bilinear;
    TextureWrap wrap = TextureWrap::repeat;
    Eigen::Matrix3d to_uv = Eigen::Matrix3d::Identity();
};
// Throws InputError (without a location) if the file cannot be read or has values that are negative or not finite.
std::unique_ptr<Texture> make_bitmap(const BitmapParams& params);

std::unique_ptr<Texture> make_checkerboard(const Spectrum& color0, const Spectrum& color1,
                                           const Eigen::Matrix3d& to_uv);

// A colour that costs a texture lookup only where there is a texture.
struct ColorInput {
    Spectrum constant = Spectrum::Zero();
    std::shared_ptr<const Texture> texture;

    ColorInput() = default;
    ColorInput(const Spectrum& value) : constant(value) {}
    ColorInput(std::shared_ptr<const Texture> t) : texture(std::move(t)) {}

    Spectrum operator()(const Vec2& uv) const { return texture ? texture->eval(uv) : constant; }
    Spectrum mean() const { return texture ? texture->mean() : constant; }
    double maximum() const { return texture ? texture->maximum() : constant.maxCoeff(); }
};

// The same for a number (a texture's luminance).
struct ScalarInput {
    double constant = 0;
    std::shared_ptr<const Texture> texture;

    ScalarInput() = default;
    ScalarInput(double value) : constant(value) {}
    ScalarInput(std::shared_ptr<const Texture> t) : texture(std::move(t)) {}

    double operator()(const Vec2& uv) const { return texture ? luminance(texture->eval(uv)) : constant; }
    double mean() const { return texture ? luminance(texture->mean()) : constant; }
};

}  // namespace keyhole
