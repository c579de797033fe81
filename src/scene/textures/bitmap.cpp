// Image textures. Texels stay as compact as in the file (8-bit files: one byte a channel) and are decoded at lookup.
#include <array>
#include <cmath>

#include "base/srgb.h"
#include "scene/texture.h"
#include "scene/textures/image_file.h"
#include "scene/textures/uv_map.h"

namespace keyhole {
namespace {

using DecodeTable = std::array<double, 256>;

DecodeTable make_table(bool srgb) {
    DecodeTable table;
    for (int i = 0; i < 256; ++i) table[i] = srgb ? srgb_decode(i / 255.0) : i / 255.0;
    return table;
}
const DecodeTable& table_for(bool srgb) {
    static const DecodeTable linear = make_table(false), decoded = make_table(true);
    return srgb ? decoded : linear;
}

// Index of the texel that stands for texel `i` (an integral value, maybe outside the image). NaN gives texel 0.
int wrapped(double i, int size, TextureWrap wrap) {
    if (wrap == TextureWrap::repeat) i -= size * std::floor(i / size);
    if (wrap == TextureWrap::mirror) {
        i -= 2 * size * std::floor(i / (2 * size));
        if (i >= size) i = 2 * size - 1 - i;
    }
    return i > 0 ? (i < size ? static_cast<int>(i) : size - 1) : 0;
}

template <class T, int channels>
class Bitmap final : public Texture {
  public:
    Bitmap(const BitmapParams& params, int width, int height, std::vector<T> texels)
        : width_(width),
          height_(height),
          filter_(params.filter),
          wrap_(params.wrap),
          map_(params.to_uv),
          table_(table_for(!params.raw)),
          texels_(std::move(texels)) {
        Spectrum sum = Spectrum::Zero();
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const Spectrum value = texel(x, y);
                sum += value;
                maximum_ = std::max(maximum_, value.maxCoeff());
            }
        mean_ = sum / (static_cast<double>(width_) * height_);
    }

    Spectrum eval(const Vec2& uv) const override {
        const Vec2 p = map_(uv);
        if (filter_ == TextureFilter::nearest)
            return texel(wrapped(std::floor(p.x() * width_), width_, wrap_),
                         wrapped(std::floor(p.y() * height_), height_, wrap_));
        const Cell c = cell(p);
        return (1 - c.y) * ((1 - c.x) * texel(c.x0, c.y0) + c.x * texel(c.x1, c.y0)) +
               c.y * ((1 - c.x) * texel(c.x0, c.y1) + c.x * texel(c.x1, c.y1));
    }

    // Of the bilinear interpolant, whatever the filter.
    Vec2 gradient(const Vec2& uv) const override {
        const Cell c = cell(map_(uv));
        const double l00 = luminance(texel(c.x0, c.y0)), l10 = luminance(texel(c.x1, c.y0));
        const double l01 = luminance(texel(c.x0, c.y1)), l11 = luminance(texel(c.x1, c.y1));
        const double dx = (1 - c.y) * (l10 - l00) + c.y * (l11 - l01);
        const double dy = (1 - c.x) * (l01 - l00) + c.x * (l11 - l10);
        return map_.pull_back({dx * width_, dy * height_});
    }

    Spectrum mean() const override { return mean_; }
    double maximum() const override { return maximum_; }
    std::size_t bytes() const override { return sizeof(*this) + texels_.size() * sizeof(T); }

  private:
    // The four texels whose centres surround a point, and the point's place among them in [0, 1)^2.
    struct Cell {
        int x0, x1, y0, y1;
        double x, y;
    };
    Cell cell(const Vec2& p) const {
        const double x = p.x() * width_ - 0.5, y = p.y() * height_ - 0.5;
        const double left = std::floor(x), top = std::floor(y);
        return {wrapped(left, width_, wrap_),
                wrapped(left + 1, width_, wrap_),
                wrapped(top, height_, wrap_),
                wrapped(top + 1, height_, wrap_),
                x - left,
                y - top};
    }

    double decoded(std::uint8_t value) const { return table_[value]; }
    double decoded(float value) const { return value; }

    Spectrum texel(int x, int y) const {
        const T* t = &texels_[(static_cast<std::size_t>(y) * width_ + x) * channels];
        if constexpr (channels == 1) return Spectrum::Constant(decoded(t[0]));
        return {decoded(t[0]), decoded(t[channels / 2]), decoded(t[channels - 1])};
    }

    int width_, height_;
    TextureFilter filter_;
    TextureWrap wrap_;
    UvMap map_;
    const DecodeTable& table_;
    std::vector<T> texels_;
    Spectrum mean_ = Spectrum::Zero();
    double maximum_ = 0;
};

template <class T>
std::unique_ptr<Texture> make(const BitmapParams& params, const ImageFile& image, std::vector<T> texels) {
    if (image.channels == 1)
        return std::make_unique<Bitmap<T, 1>>(params, image.width, image.height, std::move(texels));
    return std::make_unique<Bitmap<T, 3>>(params, image.width, image.height, std::move(texels));
}

}  // namespace

std::unique_ptr<Texture> make_bitmap(const BitmapParams& params) {
    ImageFile image = read_image_file(params.filename);
    if (!image.bytes.empty()) return make(params, image, std::move(image.bytes));
    if (image.integer && !params.raw)
        for (float& value : image.floats) value = static_cast<float>(srgb_decode(value));
    return make(params, image, std::move(image.floats));
}

}  // namespace keyhole
