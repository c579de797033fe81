// The two reference estimators. Each draws one sample: an eye path through a given raster position and, for bdpt, a
// light path, and splats all contributions f / p, weighted over the techniques it uses.
#pragma once

#include "base/rng.h"
#include "pathspace/connect.h"
#include "render/film.h"

namespace keyhole {

struct LengthRange {
    int min = 1, max = 12;  // edges
    bool contains(int k) const { return k >= min && k <= max; }
};

class Sampler {
  public:
    Sampler(const Scene& scene, LengthRange lengths)
        : tracer_(scene), window_(scene.film()), lengths_(lengths), eye_(lengths.max + 1) {}
    virtual ~Sampler() = default;

    // `raster` is uniform over the window (or stratified).
    virtual void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) = 0;

    const Tracer& tracer() const { return tracer_; }
    std::uint64_t non_finite() const { return non_finite_; }

  protected:
    // Adds a contribution unless it is NaN or infinite, which is counted.
    void splat(RadianceFilm& film, const Vec2& raster, const Spectrum& contribution);
    // Traces x_0, x_1, ... and calls visit(t, extension) after each new vertex x_{t-1}, t >= 2.
    template <class Visit>
    SensorPoint trace_eye(const Vec2& raster, Rng& rng, Visit&& visit);

    Tracer tracer_;
    RasterWindow window_;
    LengthRange lengths_;
    std::vector<Vertex> eye_;
    std::uint64_t non_finite_ = 0;
};

// Path tracing with next-event estimation, weighted between the two. Does not find light that reaches the scene only
// from emitters at a point or in one direction by way of delta lobes.
class PathSampler : public Sampler {
  public:
    using Sampler::Sampler;
    void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) override;
};

// Bidirectional path tracing, all techniques [Veach 1997, chapter 10].
class BdptSampler : public Sampler {
  public:
    BdptSampler(const Scene& scene, LengthRange lengths) : Sampler(scene, lengths), light_(lengths.max + 1) {}
    void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) override;

  private:
    int trace_light(Rng& rng);
    std::vector<Vertex> light_;
};

}  // namespace keyhole
