// Light from an image of the surroundings in latitude-longitude format (Mitsuba's `envmap`).
//
// With up = +y, a direction d of the image's space has u = atan2(d.x, -d.z) / 2 pi and v = acos(d.y) / pi, v = 0 the
// top row. Radiance is bilinear between texel centres, periodic in u and constant in v beyond the centres of the first
// and last rows. Between four neighbouring centres lies a cell: rows 0 to height of cells, the first and the last of
// them the half rows at the poles.
//
// Sampling: `u_part` chooses a cell by its share of (mean luminance of the four corners) * (solid angle), `u` the place
// in it with a density bilinear in u and in the cosine of the polar angle, which is close to the radiance (bilinear in
// u and v) and exactly invertible. The density is continuous across cells and positive where the luminance is.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/emitters.h"
#include "scene/emitters/infinite.h"
#include "scene/orthogonal.h"
#include "scene/textures/image_file.h"

namespace keyhole {
namespace {

class Envmap final : public InfiniteEmitter {
  public:
    Envmap(const EnvmapParams& params, const ImageFile& image)
        : to_world_(orthogonal_part(params.to_world, "emitter")),
          scale_(params.scale),
          width_(image.width),
          height_(image.height),
          texels_(linear_rgb(image)) {
        traits_.environment = true;
        for (int row = 0; row <= height_ + 1; ++row) cosines_.push_back(std::cos(polar_angle(row)));
        integral_ = integrate();
        build_distribution();
    }

    EmitterPoint sample_point(double u_part, const Vec2& u) const override {
        const auto next = std::upper_bound(distribution_.begin(), distribution_.end() - 1, u_part);
        const auto index = next - distribution_.begin() - 1;
        const int row = static_cast<int>(index / width_), column = static_cast<int>(index % width_);
        const Vec2 place = square_to_bilinear(u, luminances(row, column));
        const double cosine = cosines_[row] + place.y() * (cosines_[row + 1] - cosines_[row]);
        const double sine = safe_sqrt((1 - cosine) * (1 + cosine));
        const double phi = 2 * pi * (column + 0.5 + place.x()) / width_;
        const Vec3 d(sine * std::sin(phi), cosine, -sine * std::cos(phi));
        return {to_world_ * d, Vec3::Zero(), {0, 0}, density(row, column, place)};
    }
    std::optional<EmitterNumbers> invert_point(const EmitterPoint& e, const InverseNumbers& v) const override {
        const Vec3 d = to_world_.transpose() * e.p;
        const Cell c = cell(d);
        const std::size_t index = static_cast<std::size_t>(c.row) * width_ + c.column;
        if (!(distribution_[index + 1] > distribution_[index])) return std::nullopt;
        return EmitterNumbers{number_in_interval(v.place, distribution_[index], distribution_[index + 1]),
                              bilinear_to_square(place(c, d), luminances(c.row, c.column))};
    }
    double pdf_point(const EmitterPoint& e) const override {
        const Vec3 d = to_world_.transpose() * e.p;
        const Cell c = cell(d);
        return density(c.row, c.column, place(c, d));
    }

    Spectrum emitted(const EmitterPoint& e, const Vec3&) const override { return lookup(e.p); }
    Spectrum radiance(const EmitterPoint& e, const Vec3&) const override { return lookup(e.p); }
    Spectrum power() const override { return integral_ * (scale_ * disk_area()); }
    const char* name() const override { return "envmap"; }

  private:
    // The cell that a direction lies in and the place there, bilinear in u and v.
    struct Cell {
        int row, column;
        double x, y;
    };
    // Indices stay inside the image whatever `d`; the place of a direction that is not finite is NaN.
    Cell cell(const Vec3& d) const {
        const double u = std::atan2(d.x(), -d.z()) * (inv_pi / 2),
                     v = std::atan2(std::hypot(d.x(), d.z()), d.y()) * inv_pi;
        double x = u * width_ - 0.5;
        if (x < 0) x += width_;
        const double y = v * height_ + 0.5;
        const int column = x > 0 ? std::min(static_cast<int>(x), width_ - 1) : 0;
        const int row = y > 0 ? std::min(static_cast<int>(y), height_) : 0;
        return {row, column, x - column, y - row};
    }

    // The place of a direction in its cell, linear in the cosine.
    Vec2 place(const Cell& c, const Vec3& d) const {
        const double y = (cosines_[c.row] - d.y()) / (cosines_[c.row] - cosines_[c.row + 1]);
        // The row was found by the angle: rounding may leave the cosine just outside it.
        return {c.x, std::clamp(y, 0.0, 1.0)};
    }

    // Polar angle of the upper edge of a row of cells.
    double polar_angle(int row) const { return pi * std::clamp((row - 0.5) / height_, 0.0, 1.0); }

    Spectrum texel(int row, int column) const {
        const float* t = &texels_[3 * (static_cast<std::size_t>(row) * width_ + column)];
        return {t[0], t[1], t[2]};
    }
    // Texel rows and columns at the edges of a cell.
    int above(int row) const { return std::max(row - 1, 0); }
    int below(int row) const { return std::min(row, height_ - 1); }
    int right_of(int column) const { return column + 1 < width_ ? column + 1 : 0; }

    Spectrum lookup(const Vec3& world) const {
        const Cell c = cell(to_world_.transpose() * world);
        const int right = right_of(c.column), top = above(c.row), bottom = below(c.row);
        return scale_ * ((1 - c.y) * ((1 - c.x) * texel(top, c.column) + c.x * texel(top, right)) +
                         c.y * ((1 - c.x) * texel(bottom, c.column) + c.x * texel(bottom, right)));
    }
    Bilinear luminances(int row, int column) const {
        const int right = right_of(column), top = above(row), bottom = below(row);
        return {luminance(texel(top, column)), luminance(texel(top, right)), luminance(texel(bottom, column)),
                luminance(texel(bottom, right))};
    }

    double solid_angle(int row) const { return 2 * pi / width_ * (cosines_[row] - cosines_[row + 1]); }

    // Solid-angle density of the sampler at a place in a cell. The cell's probability is that of the table as rounded.
    double density(int row, int column, const Vec2& place) const {
        const std::size_t index = static_cast<std::size_t>(row) * width_ + column;
        const double probability = distribution_[index + 1] - distribution_[index];
        return probability * square_to_bilinear_pdf(place, luminances(row, column)) / solid_angle(row);
    }

    void build_distribution() {
        distribution_.assign((static_cast<std::size_t>(height_) + 1) * width_ + 1, 0);
        double total = 0;
        for_each_cell([&](int row, int column, double& value) {
            value = luminances(row, column).mean() * solid_angle(row);
            total += value;
        });
        // Cells that are not black keep a probability that survives the rounding of the sums (2^-53); a black image is
        // sampled evenly.
        const double least = total * 0x1p-48;
        double sum = 0;
        for_each_cell([&](int row, int, double& value) {
            if (total == 0) value = solid_angle(row);
            sum += value > 0 ? std::max(value, least) : 0;
            value = sum;
        });
        for (double& value : distribution_) value /= sum;
    }
    // In the order of the table, with the entry after the cell's place.
    template <class Visit>
    void for_each_cell(Visit visit) {
        std::size_t index = 0;
        for (int row = 0; row <= height_; ++row)
            for (int column = 0; column < width_; ++column) visit(row, column, distribution_[++index]);
    }

    // Integral of the image over the sphere. A texel row's share of a row of cells between the angles a and b is the
    // integral of ((b - x) or (x - a)) / (b - a) * sin(x).
    Spectrum integrate() const {
        Spectrum sum = Spectrum::Zero();
        for (int row = 0; row <= height_; ++row) {
            const double a = polar_angle(row), b = polar_angle(row + 1);
            const double slope = (std::sin(b) - std::sin(a)) / (b - a);
            sum += (cosines_[row] - slope) * row_mean(above(row)) + (slope - cosines_[row + 1]) * row_mean(below(row));
        }
        return 2 * pi * sum;
    }
    Spectrum row_mean(int row) const {
        Spectrum sum = Spectrum::Zero();
        for (int column = 0; column < width_; ++column) sum += texel(row, column);
        return sum / width_;
    }

    Matrix3 to_world_;
    double scale_;
    int width_, height_;
    std::vector<float> texels_;         // RGB, rows from the top
    std::vector<double> cosines_;       // of the upper edges of the rows of cells, and -1
    std::vector<double> distribution_;  // cumulative probabilities of the cells
    Spectrum integral_;
};

}  // namespace

std::unique_ptr<Emitter> make_envmap_emitter(const EnvmapParams& params) {
    if (!(params.scale >= 0) || !std::isfinite(params.scale))
        throw std::invalid_argument("scale must be finite and not negative");
    return std::make_unique<Envmap>(params, read_image_file(params.filename));
}

}  // namespace keyhole
