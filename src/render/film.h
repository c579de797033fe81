// Films that give the same bits whatever the order of their splats: sums of fixed-point integers.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
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
    static constexpr bool packed = sizeof(Word) == 8 && !Shared;  // pixels of four words, added to all at once
    static constexpr std::size_t bytes_per_pixel = (packed ? 4 : 3) * sizeof(Word);

    explicit FixedPointFilm(const FilmSettings& settings)
        : settings_(settings),
          packed_limit_(0x1p50 / one / std::max(1.0, sqr(settings.filter.scale))),
          pixels_(static_cast<std::size_t>(settings.crop_width) * settings.crop_height) {}

    // Adds `value` at a raster position, spread over the pixels by the reconstruction filter. `value` is finite and not
    // negative.
    void splat(const Vec2& raster, const Spectrum& value) {
        if constexpr (packed) {
            if (value.maxCoeff() < packed_limit_) [[likely]]
                return spread(raster, Double4{value[0], value[1], value[2], 0} * one);
        }
        spread(raster, value);
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

    static constexpr double one = static_cast<double>(Int128{1} << FractionBits);

    struct Pixel {
        Word rgb[bytes_per_pixel / sizeof(Word)] = {};
        bool operator==(const Pixel&) const = default;

        void add(const Spectrum& value) {
            for (int c = 0; c < 3; ++c) {
                if constexpr (Shared)
                    std::atomic_ref(rgb[c]).fetch_add(to_fixed(value[c]), std::memory_order_relaxed);
                else
                    rgb[c] += to_fixed(value[c]);
            }
        }
        static Word to_fixed(double v) {
            if constexpr (sizeof(Word) == 8)
                return std::llrint(v * one);
            else
                return static_cast<Word>(v * one);
        }
        // In units of the last bit, below 2^51: added to `shift` they are rounded to integers, which are then the low
        // bits of its mantissa.
        void add(Double4 value) {
            constexpr double shift = 0x1.8p52;
            const auto bits = std::bit_cast<Int64x4>(value + shift) - std::bit_cast<std::int64_t>(shift);
            store_lanes(load_lanes<Int64x4>(rgb) + bits, rgb);
        }
    };

    // Pixels first to last of a row or column that the filter reaches from a position.
    struct Reach {
        int first, last;

        Reach(double position, double radius, int size)
            : first(std::max(0, static_cast<int>(std::ceil(position - 0.5 - radius)))),
              last(std::min(size - 1, static_cast<int>(std::floor(position - 0.5 + radius)))) {}
    };

    template <class Value>
    void spread(const Vec2& raster, const Value& value) {
        const double x = raster.x() - settings_.crop_x, y = raster.y() - settings_.crop_y;
        const ReconstructionFilter& filter = settings_.filter;
        if (filter.radius <= 0.5) {  // the pixel under the position
            const int px = static_cast<int>(std::floor(x)), py = static_cast<int>(std::floor(y));
            if (px >= 0 && py >= 0 && px < width() && py < height()) pixel(px, py)->add(value);
            return;
        }
        constexpr int most = 8;  // columns at a time
        const Reach columns(x, filter.radius, width()), rows(y, filter.radius, height());
        for (int first = columns.first; first <= columns.last; first += most) {
            const int count = std::min(most, columns.last - first + 1);
            double weights[most];
            for (int i = 0; i < count; ++i) weights[i] = filter(first + i + 0.5 - x);
            for (int py = rows.first; py <= rows.last; ++py) {
                const Value row = value * filter(py + 0.5 - y);
                Pixel* p = pixel(first, py);
                for (int i = 0; i < count; ++i) p[i].add(Value(row * weights[i]));
            }
        }
    }

    Pixel* pixel(int px, int py) { return &pixels_[static_cast<std::size_t>(py) * width() + px]; }

    FilmSettings settings_;
    double packed_limit_;  // whatever is below stays below 2^50 units under the filter's peak
    std::vector<Pixel> pixels_;
};

using MetropolisFilm = FixedPointFilm<std::int64_t, 24>;
using SharedMetropolisFilm = FixedPointFilm<std::int64_t, 24, true>;
using RadianceFilm = FixedPointFilm<Int128, 64>;

}  // namespace keyhole
