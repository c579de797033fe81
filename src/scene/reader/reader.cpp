#include "scene/reader.h"

#include <chrono>

#include "scene/reader/files.h"
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Calls `f` for every element below `parent`, in order.
template <class F>
void for_each_element(const Element& parent, F&& f) {
    for (const Element& child : parent.children) {
        f(child);
        for_each_element(child, f);
    }
}

// The first pass: which files will be needed. A mistake is left for the second pass, which meets all of them in the
// order of the file.
void request_assets(Context& context) {
    for_each_element(context.document.scene, [&](const Element& element) {
        Notes silent;
        try {
            if (const std::string* spd = element.tag == "spectrum" ? element.attribute("filename") : nullptr)
                context.assets.request(find_file(*spd, element.where, context.document.filename));
            if (element.tag != "texture" && element.tag != "shape" && element.tag != "emitter") return;
            Properties p(element, context.document, silent);
            if (element.tag == "texture") {
                if (const auto request = bitmap_request(p, context)) context.assets.request(*request);
            } else if (element.tag == "shape") {
                if (const auto request = mesh_request(p, context)) context.assets.request(*request);
            } else if (p.has("filename")) {
                context.assets.request(context.file(p, "filename"));
            }
        } catch (const InputError&) {
            return;
        }
    });
}

bool is_group(const Element& element) {
    return element.tag == "shape" && element.required_attribute("type") == "shapegroup";
}

// The only one of its kind, or null.
const Element* only(const Document& document, const std::string& tag) {
    const Element* found = nullptr;
    for (const Element& child : document.scene.children) {
        if (child.tag != tag) continue;
        if (found) throw InputError(child.where, "a second " + tag + "; first at " + place_text(found->where));
        found = &child;
    }
    return found;
}

// What can be said without reading any file.
void check_counts(const Document& document) {
    if (!only(document, "sensor")) throw InputError(document.scene.where, "the scene has no <sensor>");
    only(document, "integrator");
    const Element* found = nullptr;
    for (const Element& child : document.scene.children) {
        if (child.tag != "emitter") continue;
        const std::string& type = child.required_attribute("type");
        if (type != "constant" && type != "envmap") continue;
        if (found) throw InputError(child.where, "a second environment emitter; first at " + place_text(found->where));
        found = &child;
    }
}

void build_element(const Element& element, Context& context, const ReaderOptions& options) {
    if (element.tag == "shape") {
        if (!is_group(element)) add_shape(element, context);
    } else if (element.tag == "emitter") {
        add_emitter(element, context);
    } else if (element.tag == "sensor") {
        set_sensor(element, context, options);
    } else if (element.tag == "integrator") {
        set_integrator(element, context);
    } else if (element.tag == "bsdf") {
        context.bsdf(element);
    } else if (element.tag == "texture") {
        context.texture(element);
    } else if (element.tag != "alias") {
        throw InputError(element.where, "misplaced element <" + element.tag + "> in <scene>: it belongs into a sensor");
    }
}

// The second pass.
void build_elements(Context& context, const ReaderOptions& options) {
    const Document& document = context.document;
    for (const Element& child : document.scene.children)
        if (is_group(child)) add_shape(child, context);
    for (const Element& child : document.scene.children) build_element(child, context, options);
}

// Definitions that no <ref> names.
void note_unreferenced(Context& context) {
    for (const Element& child : context.document.scene.children) {
        if (child.tag != "bsdf" && child.tag != "texture" && !is_group(child)) continue;
        if (context.notes.referenced.contains(&child)) continue;
        const std::string* id = child.attribute("id");
        context.notes.unused.push_back((is_group(child) ? "shapegroup" : child.tag) +
                                       (id ? " '" + *id + "'" : " without id") + " is not referred to (" +
                                       place_text(child.where) + ")");
    }
}

std::uint64_t hash_of(const Context& context, const ReaderOptions& o) {
    Hash hash;
    hash.add(content_hash(context.document));
    hash.add(context.assets.hash());
    for (const int value :
         {o.width, o.height, static_cast<int>(o.override_crop), o.crop_x, o.crop_y, o.crop_width, o.crop_height})
        hash.add(static_cast<std::uint64_t>(value));
    if (o.filter) hash.add(static_cast<std::uint64_t>(o.filter->type));
    return hash.value();
}

}  // namespace

LoadedScene read_scene(const std::string& filename, const ReaderOptions& options) {
    const auto start = Clock::now();
    const Document document = load_document(filename, options.defines, options.portals);
    check_counts(document);
    Context context(document, options.lenient);
    request_assets(context);
    context.assets.load();
    build_elements(context, options);
    note_unreferenced(context);
    context.report_textures();
    context.builder.set_robust(options.robust);
    context.builder.set_content_hash(hash_of(context, options));

    LoadedScene loaded;
    loaded.seconds_reading = seconds_since(start);
    const auto building = Clock::now();
    try {
        loaded.scene = context.builder.build();
    } catch (const std::invalid_argument& e) {
        throw InputError(document.scene.where, e.what());
    }
    loaded.seconds_building = seconds_since(building);
    loaded.warnings = std::move(context.notes.warnings);
    loaded.unused = std::move(context.notes.unused);
    for (const std::string& name : document.unused_defaults) loaded.unused.push_back(name + " is not used");
    return loaded;
}

}  // namespace keyhole
