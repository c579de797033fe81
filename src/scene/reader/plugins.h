// The tables of plugins: what `type` may be, and what makes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/filter.h"
#include "scene/reader/context.h"
#include "scene/sensor.h"

namespace keyhole {

template <class Maker>
struct Plugin {
    std::string type;
    Maker make;
};

template <class Maker>
using Plugins = std::vector<Plugin<Maker>>;

// Throws InputError for an unknown type, listing the known ones.
template <class Maker>
const Maker& find_plugin(const Plugins<Maker>& plugins, const Element& element) {
    const std::string& type = element.required_attribute("type");
    std::vector<std::string> names;
    for (const auto& plugin : plugins) {
        if (plugin.type == type) return plugin.make;
        names.push_back(plugin.type);
    }
    throw InputError(element.where, "unknown " + element.tag + " '" + type + "'; " + valid_names(type, names));
}

using BsdfMaker = BsdfPtr (*)(Properties&, Context&);
using TextureMaker = std::shared_ptr<const Texture> (*)(Properties&, Context&);
using ShapeMaker = void (*)(Properties&, Context&);  // adds it to the builder
using EmitterMaker = std::unique_ptr<Emitter> (*)(Properties&, Context&);
using SensorMaker = std::unique_ptr<Sensor> (*)(Properties&, const FilmSettings&);
using FilterMaker = ReconstructionFilter (*)(Properties&);

const Plugins<BsdfMaker>& bsdf_plugins();
const Plugins<TextureMaker>& texture_plugins();
const Plugins<ShapeMaker>& shape_plugins();
const Plugins<EmitterMaker>& emitter_plugins();
const Plugins<SensorMaker>& sensor_plugins();
const Plugins<FilterMaker>& filter_plugins();

// What the first pass over a scene asks the assets for; empty if it is not such a plugin.
std::optional<MeshRequest> mesh_request(Properties& p, const Context& context);
std::optional<BitmapParams> bitmap_request(Properties& p, const Context& context);

// A <shape> and all inside it.
void add_shape(const Element& element, Context& context);

// A top-level <emitter>.
void add_emitter(const Element& element, Context& context);

// A <sensor> with its film and sampler.
struct ReaderOptions;
void set_sensor(const Element& element, Context& context, const ReaderOptions& options);

// An <integrator>: only its max_depth is read.
void set_integrator(const Element& element, Context& context);

// The film of a sensor (null: Mitsuba's default), with what the command line replaces in it.
FilmSettings read_film(const Element* film, Context& context, const ReaderOptions& options);
// A sampler is only checked and noted as without effect.
void note_sampler(const Element& sampler, Context& context);

}  // namespace keyhole
