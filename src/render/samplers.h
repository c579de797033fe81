// The two reference estimators. Each draws one sample: an eye path through a given raster position and, for bdpt, a
// light path, and splats all contributions f / p, weighted over the techniques it uses.
#pragma once

#include "base/rng.h"
#include "pathspace/all_connections.h"
#include "render/film.h"

namespace keyhole {

class Sampler {
  public:
    virtual ~Sampler() = default;

    // `raster` is uniform over the window (or stratified).
    virtual void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) = 0;
    virtual const Tracer& tracer() const = 0;

    std::uint64_t non_finite() const { return non_finite_; }

  protected:
    // Adds a contribution unless it is NaN or infinite, which is counted.
    void splat(RadianceFilm& film, const Vec2& raster, const Spectrum& contribution);

    std::uint64_t non_finite_ = 0;
};

// Path tracing with next-event estimation, weighted between the two. Does not find light that reaches the scene only
// from emitters at a point or in one direction by way of delta lobes.
class PathSampler : public Sampler {
  public:
    PathSampler(const Scene& scene, LengthRange lengths)
        : tracer_(scene), window_(scene.film()), lengths_(lengths), eye_(lengths.max + 1) {}
    void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) override;
    const Tracer& tracer() const override { return tracer_; }

  private:
    // The contributions of the paths that end at, or right after, the eye subpath's last vertex.
    Spectrum light_at(std::span<const Vertex> eye, Rng& rng);
    Spectrum connected(std::span<const Vertex> eye, std::span<const Vertex> light);

    Tracer tracer_;
    RasterWindow window_;
    LengthRange lengths_;
    std::vector<Vertex> eye_;
};

// Bidirectional path tracing, all techniques [Veach 1997, chapter 10].
class BdptSampler : public Sampler {
  public:
    BdptSampler(const Scene& scene, LengthRange lengths) : connections_(scene, lengths) {}
    void sample(const Vec2& raster, Rng& rng, RadianceFilm& film) override;
    const Tracer& tracer() const override { return connections_.tracer(); }

  private:
    AllConnections connections_;
};

}  // namespace keyhole
