// Sensors: the eye end of a path. As with emitters, the endpoint (a point on the aperture or, for an orthographic
// sensor, a direction at infinity) is drawn first and the ray that leaves it second.
//
// Raster positions are in pixels, (0,0) the top left corner of the whole film. Importance is normalised so that the
// measurement is the integral of radiance over raster area: a pixel under the box filter is the mean radiance it sees.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "base/vec.h"

namespace keyhole {

struct SensorPoint {
    Vec3 p;          // position; orthographic: unit direction from the scene towards the sensor
    double pdf = 1;  // area density on the aperture; 1 for a pinhole and for an orthographic sensor
};

struct SensorRay {
    Vec3 o, d;                                              // o lies on the near plane, d is unit length
    double tfar = std::numeric_limits<double>::infinity();  // from o to the far plane
    double raster_per_measure = 0;                          // as SensorView's
};

// How a sensor sees a point of the scene from an endpoint.
struct SensorView {
    Vec2 raster;
    Vec3 o;             // where the ray towards the point leaves the sensor (near plane)
    double importance;  // raster area per solid angle at the endpoint (orthographic: per area perpendicular to the
                        // ray), times the aperture's density: the We * cos of the theory page
    double raster_per_measure;  // raster area per solid angle (orthographic: per perpendicular area) alone; times the
                                // density of the raster position it is the density of the ray
};

struct SensorTraits {
    bool aperture = false;  // the endpoint takes two random numbers
    bool infinite = false;  // orthographic
};

class Sensor {
  public:
    virtual ~Sensor() = default;
    virtual SensorPoint sample_point(const Vec2& u) const = 0;
    // Its inverse: `unused` where it reads no numbers.
    virtual Vec2 invert_point(const SensorPoint& e, const Vec2& unused) const = 0;
    virtual SensorRay ray(const SensorPoint& e, const Vec2& raster) const = 0;
    // Empty if `x` is behind the sensor, nearer than the near plane or farther than the far plane. The raster position
    // may lie outside the film.
    virtual std::optional<SensorView> view(const SensorPoint& e, const Vec3& x) const = 0;
    // The raster position whose ray has the unit direction d. Empty behind the sensor, and where all rays are parallel.
    virtual std::optional<Vec2> raster_towards(const SensorPoint& e, const Vec3& d) const = 0;
    virtual const char* name() const = 0;
    const SensorTraits& traits() const { return traits_; }

  protected:
    SensorTraits traits_;
};

enum class FovAxis { x, y, diagonal, smaller, larger };

struct PerspectiveParams {
    Affine to_world = Affine::Identity();  // camera looks along local +z, +y up, +x to the left of the image
    int width = 768, height = 576;         // of the whole film
    double fov = 45;                       // degrees, along `fov_axis`
    FovAxis fov_axis = FovAxis::x;
    Vec2 principal_point_offset{0, 0};  // relative to the film's size
    double near_clip = 1e-2, far_clip = 1e4;
    double aperture_radius = 0;  // > 0: thin lens
    double focus_distance = 0;   // thin lens only
};
std::unique_ptr<Sensor> make_perspective_sensor(const PerspectiveParams& params);
std::unique_ptr<Sensor> make_thin_lens_sensor(const PerspectiveParams& params);

struct OrthographicParams {
    Affine to_world = Affine::Identity();  // sees [-1,1]^2 of the local xy plane (times height/width in y), along +z
    int width = 768, height = 576;
    double near_clip = 1e-2, far_clip = 1e4;
};
std::unique_ptr<Sensor> make_orthographic_sensor(const OrthographicParams& params);

}  // namespace keyhole
