// Two colours in a pattern of 2x2 squares per unit of texture space (Mitsuba's `checkerboard`).
#include <cmath>

#include "scene/texture.h"
#include "scene/textures/uv_map.h"

namespace keyhole {
namespace {

class Checkerboard final : public Texture {
  public:
    Checkerboard(const Spectrum& color0, const Spectrum& color1, const Eigen::Matrix3d& to_uv)
        : color0_(color0), color1_(color1), map_(to_uv) {}

    Spectrum eval(const Vec2& uv) const override {
        const Vec2 p = map_(uv);
        return second_half(p.x()) == second_half(p.y()) ? color0_ : color1_;
    }
    Vec2 gradient(const Vec2&) const override { return {0, 0}; }
    Spectrum mean() const override { return 0.5 * (color0_ + color1_); }
    double maximum() const override { return color0_.max(color1_).maxCoeff(); }

  private:
    static bool second_half(double x) { return x - std::floor(x) > 0.5; }

    Spectrum color0_, color1_;
    UvMap map_;
};

}  // namespace

std::unique_ptr<Texture> make_checkerboard(const Spectrum& color0, const Spectrum& color1,
                                           const Eigen::Matrix3d& to_uv) {
    return std::make_unique<Checkerboard>(color0, color1, to_uv);
}

}  // namespace keyhole
