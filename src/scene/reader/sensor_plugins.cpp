// Sensors.
#include <cmath>

#include "scene/reader.h"
#include "scene/reader/plugins.h"
#include "scene/reader/values.h"

namespace keyhole {
namespace {

// Mitsuba's rule: a camera may be turned and mirrored, but a scale would change its units.
void check_rigid(Properties& p, const Affine& to_world) {
    const Eigen::Matrix3d gram = to_world.linear().transpose() * to_world.linear();
    if ((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3)
        p.fail(*p.find("to_world"),
               "scales or shears; the transform of a camera may only rotate, mirror and translate");
}

FovAxis fov_axis(Properties& p) {
    const std::string name = p.choice("fov_axis", {"x", "y", "diagonal", "smaller", "larger"}, "x");
    return name == "x"          ? FovAxis::x
           : name == "y"        ? FovAxis::y
           : name == "diagonal" ? FovAxis::diagonal
           : name == "smaller"  ? FovAxis::smaller
                                : FovAxis::larger;
}

// fov along fov_axis, or the focal length of a camera for 35 mm film (36 x 24 mm), which gives the angle of the
// diagonal; by default 50 mm.
void field_of_view(Properties& p, PerspectiveParams& params) {
    params.fov_axis = fov_axis(p);
    if (p.has("fov")) {
        if (p.has("focal_length")) p.fail(*p.find("focal_length"), "excludes 'fov'");
        params.fov = p.number("fov", {0, 180, true});
        return;
    }
    p.find("fov");  // a valid name
    double millimetres = 50;
    if (const Properties::Child* child = p.find("focal_length")) {
        const bool number = child->target->tag == "float" || child->target->tag == "integer";
        millimetres = number
                          ? p.number("focal_length", Range::positive())
                          : parse_with_unit(p.string("focal_length"), "mm", child->given->where, p.of("focal_length"));
        if (!(millimetres > 0)) p.fail(*child, "must be positive");
    }
    params.fov_axis = FovAxis::diagonal;
    params.fov = 2 * std::atan(std::hypot(36, 24) / (2 * millimetres)) * (180 / pi);
}

void clipping(Properties& p, double& near_clip, double& far_clip) {
    near_clip = p.number("near_clip", Range::positive(), near_clip);
    far_clip = p.number("far_clip", Range::positive(), far_clip);
    if (!(near_clip < far_clip))
        throw InputError(p.element().where, "near_clip of " + p.title() + " is " + number_text(near_clip) +
                                                "; it must be less than far_clip, " + number_text(far_clip));
}

PerspectiveParams projective(Properties& p, const FilmSettings& film) {
    PerspectiveParams params;
    params.to_world = p.transform("to_world");
    check_rigid(p, params.to_world);
    params.width = film.width;
    params.height = film.height;
    field_of_view(p, params);
    params.principal_point_offset = {p.number("principal_point_offset_x", Range::any(), 0),
                                     p.number("principal_point_offset_y", Range::any(), 0)};
    clipping(p, params.near_clip, params.far_clip);
    return params;
}

std::unique_ptr<Sensor> perspective(Properties& p, const FilmSettings& film) {
    const PerspectiveParams params = projective(p, film);
    p.ignore({"focus_distance"});
    return make_perspective_sensor(params);
}

std::unique_ptr<Sensor> thin_lens(Properties& p, const FilmSettings& film) {
    PerspectiveParams params = projective(p, film);
    params.aperture_radius = p.number("aperture_radius", Range::positive());
    params.focus_distance = p.number("focus_distance", Range::positive(), params.far_clip);
    return make_thin_lens_sensor(params);
}

std::unique_ptr<Sensor> orthographic(Properties& p, const FilmSettings& film) {
    OrthographicParams params;
    params.to_world = p.transform("to_world");
    params.width = film.width;
    params.height = film.height;
    clipping(p, params.near_clip, params.far_clip);
    return make_orthographic_sensor(params);
}

}  // namespace

const Plugins<SensorMaker>& sensor_plugins() {
    static const Plugins<SensorMaker> all = {
        {"perspective", perspective}, {"thinlens", thin_lens}, {"orthographic", orthographic}};
    return all;
}

void set_sensor(const Element& element, Context& context, const ReaderOptions& options) {
    Properties p(element, context.document, context.notes);
    const SensorMaker make = find_plugin(sensor_plugins(), element);
    const auto* film_child = p.object("film");
    const FilmSettings film = read_film(film_child ? film_child->target : nullptr, context, options);
    if (const auto* sampler = p.object("sampler")) note_sampler(*sampler->target, context);
    try {
        auto sensor = make(p, film);
        p.ignore({"shutter_open", "shutter_close"});
        p.finish();
        context.builder.set_sensor(std::move(sensor), film);
    } catch (const std::invalid_argument& e) {
        throw InputError(element.where, p.title() + ": " + e.what());
    }
}

}  // namespace keyhole
