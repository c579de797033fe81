// Textures: bitmap, checkerboard.
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

// to_uv, or the four parameters of Mitsuba 0.6.
Eigen::Matrix3d to_uv(Properties& p) {
    if (p.has("to_uv")) return p.uv_transform("to_uv");
    p.find("to_uv");  // a valid name
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    const double both = p.number("uvscale", Range::any(), 1);
    m(0, 0) = p.number("uscale", Range::any(), both);
    m(1, 1) = p.number("vscale", Range::any(), both);
    m(0, 2) = p.number("uoffset", Range::any(), 0);
    m(1, 2) = p.number("voffset", Range::any(), 0);
    if (m(0, 0) == 0 || m(1, 1) == 0)
        throw InputError(p.element().where, "the scale of u and v of " + p.title() + " must not be zero");
    return m;
}

TextureFilter filter(Properties& p) {
    const std::string name = p.choice("filter_type", {"bilinear", "nearest", "trilinear", "ewa"}, "bilinear");
    if (name == "trilinear" || name == "ewa")
        p.notes().unused.push_back(p.of("filter_type") + " '" + name + "' is read as bilinear (" +
                                   place_text(p.element().where) + ")");
    return name == "nearest" ? TextureFilter::nearest : TextureFilter::bilinear;
}

TextureWrap wrap(Properties& p) {
    const std::vector<std::string> valid = {"repeat", "mirror", "clamp"};
    const std::string both = p.choice("wrap_mode", valid, "repeat");
    const std::string u = p.choice("wrap_mode_u", valid, both), v = p.choice("wrap_mode_v", valid, both);
    if (u != v) throw InputError(p.element().where, "wrap_mode_u and wrap_mode_v of " + p.title() + " must be equal");
    return u == "repeat" ? TextureWrap::repeat : u == "mirror" ? TextureWrap::mirror : TextureWrap::clamp;
}

// `raw`, or Mitsuba 0.6's `gamma`.
bool raw(Properties& p) {
    const bool given = p.boolean("raw", false);
    const auto gamma = p.find_number("gamma", Range::any());
    if (gamma && *gamma != 1 && *gamma != -1 && *gamma != 0)
        p.fail(*p.find("gamma"), "must be 1 (linear), or 0 or -1 (decided by the file)");
    return given || (gamma && *gamma == 1);
}

BitmapParams bitmap_params(Properties& p, const Context& context) {
    BitmapParams params;
    params.filename = context.file(p, "filename");
    params.raw = raw(p);
    params.to_uv = to_uv(p);
    params.wrap = wrap(p);
    params.filter = filter(p);
    return params;
}

std::shared_ptr<const Texture> make_bitmap_plugin(Properties& p, Context& context) {
    const BitmapParams params = bitmap_params(p, context);
    p.ignore({"cache", "max_anisotropy", "accel", "format"});
    return context.assets.bitmap(params, p.element().where);
}

std::shared_ptr<const Texture> make_checkerboard_plugin(Properties& p, Context& context) {
    const auto color = [&](const char* name, double fallback) {
        return context.color(p, name, Quantity::index, Spectrum::Constant(fallback));
    };
    const Spectrum color0 = color("color0", 0.4), color1 = color("color1", 0.2);
    return make_checkerboard(color0, color1, to_uv(p));
}

}  // namespace

std::optional<BitmapParams> bitmap_request(Properties& p, const Context& context) {
    if (p.element().required_attribute("type") != "bitmap") return std::nullopt;
    return bitmap_params(p, context);
}

const Plugins<TextureMaker>& texture_plugins() {
    static const Plugins<TextureMaker> all = {{"bitmap", make_bitmap_plugin},
                                              {"checkerboard", make_checkerboard_plugin}};
    return all;
}

}  // namespace keyhole
