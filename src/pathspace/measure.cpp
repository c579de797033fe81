#include "pathspace/measure.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "pathspace/neighbours.h"

namespace keyhole {
namespace {

// A product that does not leave the range of double.
class ScaledProduct {
  public:
    void multiply(const Spectrum& factor) {
        value_ *= factor;
        const double largest = value_.maxCoeff();
        if (!(largest > 0x1p-64 && largest < 0x1p64)) rescale(largest);
    }
    void multiply(double factor) { multiply(Spectrum::Constant(factor)); }

    const Spectrum& value() const { return value_; }  // times 2^exponent
    double log_of_scale() const { return exponent_ * std::numbers::ln2; }

  private:
    void rescale(double largest) {
        if (!(largest > 0 && largest <= std::numeric_limits<double>::max())) return;
        const int e = std::ilogb(largest);
        value_ *= std::ldexp(1.0, -e);
        exponent_ += e;
    }

    Spectrum value_{1, 1, 1};
    int exponent_ = 0;
};

}  // namespace

PathFailure measure(const Scene& scene, const RasterWindow& window, TargetFunction target, std::span<const Vertex> x,
                    PathMeasure& m) {
    const int k = static_cast<int>(x.size()) - 1;
    const Vertex &x0 = x[0], &x1 = x[1], &xk = x[k];
    if (!xk.x.emitter) return PathFailure::zero_bsdf;
    // An infinite x_1 is seen from a finite sensor point.
    const auto view =
        scene.sensor().view(sensor_point(x0), x1.infinite ? Vec3(x0.x.p + scene.radius() * x1.x.p) : x1.x.p);
    if (!view || !window.contains(view->raster)) return PathFailure::outside_film;
    m.raster = view->raster;

    // f by its factors from the sensor to the emitter [Veach 1997, equation 8.7], densities beside them.
    Vec3 d = x1.infinite ? x1.x.p : Vec3(-direction(x1, x0));  // from x_i to x_{i+1}
    double far = to_measure(x0, x1, d);
    m.eye[0] = x0.pdf_fwd;
    m.light[0] = 0;
    m.eye[1] = view->raster_per_measure / window.area() * far;
    ScaledProduct f;
    f.multiply(view->importance * far);
    for (int i = 1; i < k; ++i) {
        const Vertex &v = x[i], &before = x[i - 1], &after = x[i + 1];
        const Vec3 to_eye = -d;
        d = direction(v, after);
        const Scattering s = scattering(v, to_eye, d);
        if (is_black(s.f)) return PathFailure::zero_bsdf;
        far = to_measure(v, after, d);
        m.eye[i + 1] = s.pdf_light * far;
        if (i > 1) m.light[i - 1] = s.pdf_eye * to_measure(v, before, to_eye);
        m.peak[i] = v.delta ? std::numeric_limits<double>::infinity() : std::max(s.pdf_light, s.pdf_eye);
        f.multiply(s.f);
        // The far cosine of the last edge is part of what is emitted.
        const bool last = i + 1 == k;
        f.multiply(std::abs(v.x.ng.dot(d)) * (last && !after.infinite ? 1 / (after.x.p - v.x.p).squaredNorm() : far));
    }
    const Emitter& emitter = *xk.x.emitter;
    const EmitterPoint e = emitter_point(xk);
    m.light[k] = scene.emitter_probability(&emitter) * (emitter.traits().delta ? 1 : emitter.pdf_point(e));
    if (k > 1) m.light[k - 1] = emitter.pdf_ray(e, -d) * to_measure(xk, x[k - 1], d);
    const Spectrum light = k == 1 ? emitter.radiance(e, -d) : emitter.emitted(e, -d);
    if (is_black(light)) return PathFailure::zero_bsdf;
    f.multiply(light);
    const double scalar_f = scalar(target, f.value());
    if (!std::isfinite(scalar_f)) return PathFailure::non_finite;
    if (!(scalar_f > 0)) return PathFailure::zero_bsdf;
    m.color = f.value() / scalar_f;
    m.log_f = std::log(scalar_f) + f.log_of_scale();
    return PathFailure::none;
}

double adopt_technique(TechniqueSet techniques, const PathMeasure& m, SampledPath& path) {
    const int k = path.k;
    // p_t > 0 for begin <= t <= end.
    int begin = k + 1, end = 0;
    while (begin > 0 && m.light[begin - 1] > 0) --begin;
    while (end <= k && m.eye[end] > 0) ++end;
    int t = std::max(begin, 1);
    while (t <= end && !(techniques.holds(k + 1 - t) && technique_exists(path.x(), t))) ++t;
    if (t > end) return 0;
    path.t = t;
    ScaledProduct p;
    for (int i = 0; i <= k; ++i) {
        Vertex& v = path.room[i];
        v.pdf_fwd = i < t ? m.eye[i] : m.light[i];
        v.pdf_rev = i < t ? m.light[i] : m.eye[i];
        p.multiply(v.pdf_fwd);
    }
    const auto at = [&](const std::vector<double>& densities, int i) { return i >= 0 && i <= k ? densities[i] : 0; };
    path.junction = {at(m.light, t - 1), at(m.light, t - 2), at(m.eye, t), at(m.eye, t + 1)};
    path.weight = mis_weight(path.eye(), path.light(), path.junction, techniques);
    return path.weight * std::exp(m.log_f - std::log(p.value()[0]) - p.log_of_scale());
}

}  // namespace keyhole
