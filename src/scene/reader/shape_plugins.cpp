// Shapes, with the BSDF and the area emitter inside them.
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

ColorInput area_radiance(const Element& emitter, Context& context) {
    if (emitter.required_attribute("type") != "area") {
        const std::string& type = *emitter.attribute("type");
        throw InputError(emitter.where, "emitter '" + type + "' inside a shape; " + valid_names(type, {"area"}));
    }
    Properties p(emitter, context.document, context.notes);
    ColorInput radiance = context.radiance(p, "radiance", 1);
    p.ignore({"sampling_weight"});
    p.finish();
    return radiance;
}

// What all shapes share.
ShapeOptions shape_options(Properties& p, Context& context) {
    ShapeOptions options;
    if (const std::string* id = p.element().attribute("id")) options.id = *id;
    options.to_world = p.transform("to_world");
    options.flip_normals = p.boolean("flip_normals", false);
    if (const auto* bsdf = p.object("bsdf")) options.bsdf = context.bsdf(*bsdf->target);
    if (const auto* emitter = p.object("emitter")) options.radiance = area_radiance(*emitter->target, context);
    return options;
}

void mesh(Properties& p, Context& context) {
    const auto request = *mesh_request(p, context);
    ShapeOptions options = shape_options(p, context);
    options.face_normals = p.boolean("face_normals", false);
    context.builder.add_mesh(context.assets.mesh(request, p.element().where), options);
}

void rectangle(Properties& p, Context& context) { context.builder.add_rectangle(shape_options(p, context)); }
void cube(Properties& p, Context& context) { context.builder.add_cube(shape_options(p, context)); }
void disk(Properties& p, Context& context) { context.builder.add_disk(shape_options(p, context)); }

void sphere(Properties& p, Context& context) {
    const Vec3 center = p.find_vector("center", "point").value_or(Vec3(0, 0, 0));
    const double radius = p.number("radius", Range::positive(), 1);
    context.builder.add_sphere(center, radius, shape_options(p, context));
}

void cylinder(Properties& p, Context& context) {
    const Vec3 p0 = p.find_vector("p0", "point").value_or(Vec3(0, 0, 0));
    const Vec3 p1 = p.find_vector("p1", "point").value_or(Vec3(0, 0, 1));
    if (p0 == p1) throw InputError(p.element().where, "p0 and p1 of " + p.title() + " are the same point");
    const double radius = p.number("radius", Range::positive(), 1);
    context.builder.add_cylinder(p0, p1, radius, shape_options(p, context));
}

// A rectangle, or all triangles of a mesh.
void portal(Properties& p, Context& context) {
    const Affine to_world = p.transform("to_world");
    const std::string* id = p.element().attribute("id");
    const auto at = [&](double x, double y, double z) -> Vec3 { return to_world * Vec3(x, y, z); };
    std::vector<PortalFace> faces;
    if (const auto request = mesh_request(p, context)) {
        const auto mesh = context.assets.mesh(*request, p.element().where);
        for (const auto& corners : mesh->triangles) {
            const auto corner = [&](int i) -> Vec3 {
                return to_world * mesh->positions[static_cast<std::size_t>(corners[i])].cast<double>();
            };
            faces.push_back(triangle(corner(0), corner(1), corner(2)));
        }
    } else {
        faces.push_back(parallelogram(at(-1, -1, 0), at(1, -1, 0) - at(-1, -1, 0), at(-1, 1, 0) - at(-1, -1, 0)));
    }
    context.builder.add_portal(id ? *id : "", std::move(faces));
}

void group(Properties& p, Context& context) {
    const std::string& id = p.element().required_attribute("id");
    context.builder.begin_group(id);
    for (const auto* child : p.objects("shape")) {
        const Element& shape = *child->given;
        const std::string* type = shape.attribute("type");
        if (*type == "portal") throw InputError(shape.where, "a portal stands in the scene, not in a shapegroup");
        if (shape.tag == "ref" || *type == "shapegroup" || *type == "instance")
            throw InputError(shape.where, "a shapegroup holds shapes of its own, not groups or instances");
        for (const Element& part : shape.children)
            if (part.tag == "emitter")
                throw InputError(part.where, "an emitter in a shapegroup: instances cannot emit light");
        add_shape(shape, context);
    }
    context.builder.end_group();
}

void instance(Properties& p, Context& context) {
    const Properties::Child& child = p.require_object("shape");
    if (child.target->required_attribute("type") != "shapegroup")
        throw InputError(child.given->where,
                         "an instance refers to a shapegroup, not to a " + child.target->required_attribute("type"));
    if (child.given->tag != "ref")
        throw InputError(child.given->where, "an instance holds a <ref> to a shapegroup that stands in the scene");
    context.builder.add_instance(*child.given->attribute("id"), p.transform("to_world"));
}

}  // namespace

std::optional<MeshRequest> mesh_request(Properties& p, const Context& context) {
    MeshRequest request;
    request.format = p.element().required_attribute("type");
    if (request.format == "portal") {
        if (!p.has("filename")) return std::nullopt;
        request.filename = context.file(p, "filename");
        request.format = request.filename.ends_with(".ply") ? "ply" : "obj";
        return request;
    }
    if (request.format != "obj" && request.format != "ply" && request.format != "serialized") return std::nullopt;
    request.filename = context.file(p, "filename");
    if (request.format == "serialized") request.shape_index = p.integer("shape_index", 0, 1 << 30, 0);
    // Textures measure v from the bottom of the image, as OBJ files do; Mitsuba reads the other formats the other way.
    request.flip_v = !p.boolean("flip_tex_coords", request.format == "obj");
    return request;
}

const Plugins<ShapeMaker>& shape_plugins() {
    static const Plugins<ShapeMaker> all = {
        {"obj", mesh},         {"ply", mesh},          {"serialized", mesh}, {"rectangle", rectangle},
        {"cube", cube},        {"sphere", sphere},     {"disk", disk},       {"cylinder", cylinder},
        {"shapegroup", group}, {"instance", instance}, {"portal", portal},
    };
    return all;
}

void add_shape(const Element& element, Context& context) {
    Properties p(element, context.document, context.notes);
    try {
        find_plugin(shape_plugins(), element)(p, context);
    } catch (const std::invalid_argument& e) {
        throw InputError(element.where, p.title() + ": " + e.what());
    }
    p.finish();
}

}  // namespace keyhole
