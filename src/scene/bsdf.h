// Bidirectional scattering distribution functions.
//
// Directions are unit vectors in the local shading frame (normal +z), pointing away from the surface. `w_eye` points
// towards the sensor end of the path and `w_light` towards the emitter end: light arrives from `w_light` and leaves to
// `w_eye`. Radiance scaling at refraction is part of f, so f is one number whichever end a path was sampled from; it is
// not symmetric in its arguments where a surface refracts.
//
// Lobes are smooth (finite f) or delta (mirror, smooth refraction, null). `eval` sees only the smooth ones.
#pragma once

#include <cstdint>
#include <optional>

#include "base/spectrum.h"
#include "base/vec.h"
#include "scene/inverse_numbers.h"
#include "scene/surface.h"

namespace keyhole {

// Which end of the path the known direction belongs to.
enum class Mode : std::uint8_t {
    eye,   // w_eye is known, w_light is sampled
    light  // w_light is known, w_eye is sampled
};

struct BsdfValue {
    Spectrum f;        // without the cosine
    double pdf_light;  // solid-angle density with which `sample` draws w_light given w_eye
    double pdf_eye;    // and w_eye given w_light
};

struct BsdfSample {
    Vec3 w;                 // the sampled direction, local
    Spectrum weight;        // f * |cos theta(w)| / pdf; for a delta lobe its coefficient over its probability
    double pdf;             // solid-angle density over all smooth lobes; for a delta lobe its probability
    double pdf_reverse;     // the same with the two directions exchanged
    double eta = 1;         // index of refraction on w's side over the one on the known direction's side
    std::uint8_t lobe = 0;  // index of the chosen lobe, for reports and inverses
    bool delta = false;
};

// What happened at a path's vertex, apart from the directions.
struct BsdfEvent {
    bool delta = false;
    std::uint8_t lobe = 0;  // of a delta event: BsdfSample::lobe, the same seen from both ends of the path
};

// The numbers that `sample` reads.
struct BsdfNumbers {
    double lobe = 0;
    Vec2 direction{0, 0};
};

// What a BSDF has and asks for; a scene's requirements are the union over its BSDFs.
struct BsdfTraits {
    bool smooth = false;          // has a smooth lobe: path vertices on it can be connected
    bool delta = false;           // has a delta lobe
    bool transmissive = false;    // light passes to the other side
    bool chooses_lobe = false;    // `sample` reads the lobe number
    bool needs_uv = false;        // evaluates a texture
    bool needs_tangents = false;  // anisotropic or bump-mapped
    std::uint8_t lobes = 1;       // BsdfSample::lobe is less than this
};

class Bsdf {
  public:
    virtual ~Bsdf() = default;

    // Smooth lobes only; zero f and pdfs where there are none or on the wrong side. Selection probabilities of lobes
    // are part of the pdfs, so they integrate to the probability of choosing a smooth lobe (at most 1).
    virtual BsdfValue eval(const SurfacePoint& x, const Vec3& w_eye, const Vec3& w_light) const = 0;

    // Draws a direction given the other one. `u_lobe` chooses the lobe (or reflection / transmission) and nothing else,
    // `u` the direction within it; all in [0,1). Empty where nothing can be scattered.
    virtual std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& w_known, double u_lobe, const Vec2& u,
                                             Mode mode) const = 0;

    // The inverse of `sample`: numbers by which it draws `w`, in a distribution such that uniform numbers, sampled and
    // inverted, are uniform again. So the smooth lobe is drawn from the posterior c_l p_l(w) / p(w), never from the
    // probabilities c_l alone (theory, section 4). Empty where `sample` never draws `w` in such an event.
    virtual std::optional<BsdfNumbers> invert(const SurfacePoint& x, const Vec3& w_known, const Vec3& w,
                                              const BsdfEvent& event, const InverseNumbers& v, Mode mode) const = 0;

    virtual const char* name() const = 0;  // the plugin's name in scene files

    const BsdfTraits& traits() const { return traits_; }

  protected:
    BsdfTraits traits_;
};

}  // namespace keyhole
