// Films that give the same bits whatever the order of their splats: sums of fixed-point integers.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/spectrum.h"
#include "base/vec.h"
#include "render/image.h"
#include "scene/filter.h"

namespace keyhole {

__extension__ using Int128 = __int128;

// Word and FractionBits set range and resolution. A Metropolis splat is f / f* (luminance one) times a probability:
// 64 bits with 2^-24 hold 5e11 of them in one pixel, and each is rounded to 6e-8. Radiance has no bound: 128 bits with
// 2^-64 hold 9e18. Several threads may splat into one film at a time if it is `Shared`.
template <class Word, int FractionBits, bool Shared = false>
class FixedPointFilm {
  public:
    static constexpr std::size_t bytes_per_pixel = 3 * sizeof(Word);

    explicit FixedPointFilm(const FilmSettings& settings)
        : settings_(settings), pixels_(static_cast<std::size_t>(settings.crop_width) * settings.crop_height) {}

    // Adds `value` at a raster position, spread over the pixels by the reconstruction filter. `value` is finite.
    void splat(const Vec2& raster, const Spectrum& value) {
        const double x = raster.x() - settings_.crop_x, y = raster.y() - settings_.crop_y;
        const double radius = settings_.filter.radius;
        if (radius <= 0.5) {  // the pixel under the position
            const int px = static_cast<int>(std::floor(x)), py = static_cast<int>(std::floor(y));
            if (px >= 0 && py >= 0 && px < width() && py < height()) add(px, py, value);
            return;
        }
        const int x0 = std::max(0, static_cast<int>(std::ceil(x - 0.5 - radius)));
        const int x1 = std::min(width() - 1, static_cast<int>(std::floor(x - 0.5 + radius)));
        const int y0 = std::max(0, static_cast<int>(std::ceil(y - 0.5 - radius)));
        const int y1 = std::min(height() - 1, static_cast<int>(std::floor(y - 0.5 + radius)));
        for (int py = y0; py <= y1; ++py) {
            const Spectrum row = value * settings_.filter(py + 0.5 - y);
            for (int px = x0; px <= x1; ++px) add(px, py, row * settings_.filter(px + 0.5 - x));
        }
    }

    template <bool OtherShared>
    void merge(const FixedPointFilm<Word, FractionBits, OtherShared>& other) {
        for (std::size_t i = 0; i < pixels_.size(); ++i)
            for (int c = 0; c < 3; ++c) pixels_[i].rgb[c] += other.pixels_[i].rgb[c];
    }
    void clear() { std::fill(pixels_.begin(), pixels_.end(), Pixel{}); }

    // The sums times `scale`.
    Image develop(double scale) const {
        Image image(width(), height());
        const double unit = std::ldexp(scale, -FractionBits);
        for (std::size_t i = 0; i < pixels_.size(); ++i)
            for (int c = 0; c < 3; ++c)
                image.rgb[3 * i + c] = static_cast<float>(static_cast<double>(pixels_[i].rgb[c]) * unit);
        return image;
    }

    int width() const { return settings_.crop_width; }
    int height() const { return settings_.crop_height; }
    bool operator==(const FixedPointFilm& other) const { return pixels_ == other.pixels_; }

  private:
    template <class, int, bool>
    friend class FixedPointFilm;

    struct Pixel {
        Word rgb[3] = {0, 0, 0};
        bool operator==(const Pixel&) const = default;
    };

    void add(int px, int py, const Spectrum& value) {
        Pixel& pixel = pixels_[static_cast<std::size_t>(py) * width() + px];
        for (int c = 0; c < 3; ++c) {
            if constexpr (Shared)
                std::atomic_ref(pixel.rgb[c]).fetch_add(to_fixed(value[c]), std::memory_order_relaxed);
            else
                pixel.rgb[c] += to_fixed(value[c]);
        }
    }
    static Word to_fixed(double v) {
        if constexpr (sizeof(Word) == 8)
            return std::llrint(v * std::ldexp(1.0, FractionBits));
        else
            return static_cast<Word>(v * std::ldexp(1.0, FractionBits));
    }

    FilmSettings settings_;
    std::vector<Pixel> pixels_;
};

using MetropolisFilm = FixedPointFilm<std::int64_t, 24>;
using SharedMetropolisFilm = FixedPointFilm<std::int64_t, 24, true>;
using RadianceFilm = FixedPointFilm<Int128, 64>;

}  // namespace keyhole
