#include "emitter_checks.h"

#include <cmath>

#include "base/frame.h"
#include "base/rng.h"
#include "base/warp.h"
#include "statistics.h"

namespace keyhole {
namespace {

constexpr int calls = 20;
constexpr int rows = 20, columns = 12;

Vec2 uniform2(Rng& rng) {
    const double a = rng.uniform();
    return {a, rng.uniform()};
}

// The absolute part is for densities that vanish linearly somewhere: near there they keep digits relative to their
// slope.
bool near(double found, double expected) { return std::abs(found - expected) <= 1e-9 * expected + 1e-14; }

// Counts over a grid of the unit disk or the sphere in cells of equal measure, about an axis.
class Counts {
  public:
    void add(double height, const Vec2& around) {  // height in [0, 1]
        const double turn = std::atan2(around.y(), around.x()) / (2 * pi) + 0.5;
        const int row = std::min(static_cast<int>(height * rows), rows - 1);
        const int column = std::min(static_cast<int>(turn * columns), columns - 1);
        ++observed_[static_cast<std::size_t>(row * columns + column)];
    }
    const std::vector<double>& observed() const { return observed_; }

  private:
    std::vector<double> observed_ = std::vector<double>(rows * columns);
};

testing::AssertionResult follows(const std::vector<double>& expected, const std::vector<double>& observed) {
    const double p = chi_square_p_value(expected, observed);
    if (p > sidak_level(1e-3, calls)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "p-value " << p;
}

// Directions from one endpoint over cells in the cosine and the azimuth about `axis`, stretched to the cap of the
// sphere that holds the density so that narrow cones fill the grid. Midpoint rule with 40 x 8 points a cell: a jump of
// the density inside a cell leaves an error below 1/40 of that cell's probability.
testing::AssertionResult directions_follow(const Emitter& emitter, const EmitterPoint& e, const Vec3& axis,
                                           double cap) {
    const int samples = 40000, fine = 40, around = 8;
    const Frame frame = Frame::from_normal(axis);
    Counts counts;
    Rng rng(11);
    for (int i = 0; i < samples; ++i) {
        const Vec3 w = frame.to_local(emitter.sample_ray(e, uniform2(rng)).d);
        counts.add(std::min(1.0, (1 - w.z()) / cap), w.head<2>());
    }
    std::vector<double> expected;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            double sum = 0;
            for (int i = 0; i < fine * around; ++i) {
                const double z = 1 - cap * (row + (i % fine + 0.5) / fine) / rows, r = safe_sqrt(1 - z * z);
                const double phi = 2 * pi * ((column + (i / fine + 0.5) / around) / columns - 0.5);
                sum += emitter.pdf_ray(e, frame.to_world({r * std::cos(phi), r * std::sin(phi), z}));
            }
            expected.push_back(samples * sum / (fine * around) * 2 * pi * cap / (rows * columns));
        }
    return follows(expected, counts.observed());
}

// Origins of the rays from one endpoint at infinity: outside the scene's sphere, even over the disk that covers it.
testing::AssertionResult origins_follow(const Emitter& emitter, const EmitterPoint& e, const Vec3& center,
                                        double radius) {
    const int samples = 40000;
    const Frame frame = Frame::from_normal(e.p);
    Counts counts;
    Rng rng(12);
    for (int i = 0; i < samples; ++i) {
        const EmissionRay ray = emitter.sample_ray(e, uniform2(rng));
        const Vec3 o = frame.to_local(ray.o - center) / radius;
        if ((ray.d + e.p).norm() > 1e-15 || !near(ray.pdf, 1 / (pi * radius * radius)) || o.z() < 1.01)
            return testing::AssertionFailure() << "a ray that does not come from the emitter";
        counts.add(o.head<2>().squaredNorm(), o.head<2>());
    }
    return follows(std::vector<double>(rows * columns, double(samples) / (rows * columns)), counts.observed());
}

}  // namespace

testing::AssertionResult samples_carry_their_densities(const Emitter& emitter) {
    const bool delta = emitter.traits().delta;
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
        const double u_part = rng.uniform();
        const EmitterPoint e = emitter.sample_point(u_part, uniform2(rng));
        if (!(delta ? e.pdf == 1 && emitter.pdf_point(e) == 0 : e.pdf > 0 && near(emitter.pdf_point(e), e.pdf)))
            return testing::AssertionFailure() << "endpoint: pdf " << e.pdf << ", pdf_point " << emitter.pdf_point(e);
        const EmissionRay ray = emitter.sample_ray(e, uniform2(rng));
        if (!(ray.pdf > 0 && near(emitter.pdf_ray(e, ray.d), ray.pdf)))
            return testing::AssertionFailure() << "ray: pdf " << ray.pdf << ", pdf_ray " << emitter.pdf_ray(e, ray.d);
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult survives_the_ends_of_the_unit_interval(const Emitter& emitter) {
    for (int bits = 0; bits < 32; ++bits) {
        const auto number = [&](int i) { return bits >> i & 1 ? one_minus_epsilon : 0; };
        const EmitterPoint e = emitter.sample_point(number(0), {number(1), number(2)});
        const EmissionRay ray = emitter.sample_ray(e, {number(3), number(4)});
        const bool finite = e.p.allFinite() && ray.o.allFinite() && std::abs(ray.d.norm() - 1) < 1e-12;
        const bool on_sphere = !emitter.traits().infinite || std::abs(e.p.norm() - 1) < 1e-12;
        if (!finite || !on_sphere || !emitter.emitted(e, ray.d).allFinite())
            return testing::AssertionFailure() << "p " << e.p.transpose() << ", d " << ray.d.transpose();
        for (const double pdf : {e.pdf, emitter.pdf_point(e), ray.pdf, emitter.pdf_ray(e, ray.d)})
            if (!(pdf >= 0 && std::isfinite(pdf))) return testing::AssertionFailure() << "density " << pdf;
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult rays_follow_their_density(const Emitter& emitter, const Vec3& center, double radius) {
    const EmitterPoint e = emitter.sample_point(0.3, {0.7, 0.2});
    if (emitter.traits().infinite) return origins_follow(emitter, e, center, radius);
    Vec3 axis = Vec3::Zero();
    Rng rng(13);
    for (int i = 0; i < 1000; ++i) axis += emitter.sample_ray(e, uniform2(rng)).d;
    axis.normalize();
    double cap = 0;
    for (int i = 0; i < 1000; ++i) cap = std::max(cap, 1 - axis.dot(emitter.sample_ray(e, uniform2(rng)).d));
    return directions_follow(emitter, e, axis, std::min(2.0, 1.2 * cap));
}

testing::AssertionResult power_is_the_integral(const Emitter& emitter) {
    const int samples = 20000;
    Rng rng(17);
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
        const double u_part = rng.uniform();
        const EmitterPoint e = emitter.sample_point(u_part, uniform2(rng));
        const EmissionRay ray = emitter.sample_ray(e, uniform2(rng));
        const double value = luminance(emitter.emitted(e, ray.d)) / (e.pdf * ray.pdf);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / samples, expected = luminance(emitter.power());
    const double error = std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples);
    const double quantile = normal_two_sided_quantile(sidak_level(1e-3, calls));
    // Estimates without variance agree up to rounding.
    if (std::abs(mean - expected) <= quantile * error + 1e-9 * expected) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "power " << expected << ", estimated " << mean << " +- " << error;
}

namespace {

// An endpoint and a ray from uniform numbers, and what the inverses make of them.
struct Inverted {
    EmitterPoint e;
    EmissionRay ray;
    std::optional<EmitterNumbers> point;
    std::optional<Vec2> direction;
};

Inverted draw_and_invert(const Emitter& emitter, Rng& rng) {
    Inverted d;
    const double u_part = rng.uniform();
    d.e = emitter.sample_point(u_part, uniform2(rng));
    d.ray = emitter.sample_ray(d.e, uniform2(rng));
    InverseNumbers v;
    v.place = rng.uniform();
    v.direction = uniform2(rng);
    d.point = emitter.invert_point(d.e, v);
    d.direction = emitter.invert_ray(d.e, d.ray.o + (0.1 + rng.uniform()) * d.ray.d);
    return d;
}

bool in_unit_interval(const Vec2& u) { return u.minCoeff() >= 0 && u.maxCoeff() < 1; }

}  // namespace

testing::AssertionResult inverse_gives_the_sample(const Emitter& emitter) {
    Rng rng(21);
    for (int i = 0; i < 5000; ++i) {
        const Inverted d = draw_and_invert(emitter, rng);
        if (!d.point || !d.direction)
            return testing::AssertionFailure() << "no inverse of " << (d.point ? "the ray" : "the endpoint");
        if (!in_unit_interval(d.point->point) || !in_unit_interval({d.point->part, 0}) ||
            !in_unit_interval(*d.direction))
            return testing::AssertionFailure() << "numbers outside [0, 1)";
        const EmitterPoint e = emitter.sample_point(d.point->part, d.point->point);
        const double size = 1 + d.e.p.norm();
        if (!((e.p - d.e.p).norm() <= 1e-9 * size && std::abs(e.pdf - d.e.pdf) <= 1e-6 * d.e.pdf + 1e-12))
            return testing::AssertionFailure() << "endpoint " << d.e.p.transpose() << " of density " << d.e.pdf
                                               << " comes back as " << e.p.transpose() << ", " << e.pdf;
        const EmissionRay ray = emitter.sample_ray(d.e, *d.direction);
        if (!((ray.o - d.ray.o).norm() <= 1e-9 * size && (ray.d - d.ray.d).norm() <= 1e-9))
            return testing::AssertionFailure()
                   << "ray " << d.ray.d.transpose() << " comes back as " << ray.d.transpose();
    }
    return testing::AssertionSuccess();
}

testing::AssertionResult inverse_numbers_are_uniform(const Emitter& emitter) {
    constexpr int draws = 20000, side = 5;
    const auto cell = [](double u) { return static_cast<std::size_t>(u * side); };
    std::vector<double> points(side * side * side), rays(side * side);
    Rng rng(22);
    for (int i = 0; i < draws; ++i) {
        const Inverted d = draw_and_invert(emitter, rng);
        if (!d.point || !d.direction) return testing::AssertionFailure() << "no inverse";
        ++points[(cell(d.point->part) * side + cell(d.point->point.x())) * side + cell(d.point->point.y())];
        ++rays[cell(d.direction->x()) * side + cell(d.direction->y())];
    }
    const auto expected = [&](std::size_t cells) { return std::vector<double>(cells, double(draws) / double(cells)); };
    if (auto result = follows(expected(points.size()), points); !result) return result << " of the endpoint's numbers";
    if (auto result = follows(expected(rays.size()), rays); !result) return result << " of the ray's numbers";
    return testing::AssertionSuccess();
}

}  // namespace keyhole
