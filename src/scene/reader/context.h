// What the plugins of a scene share while it is read.
#pragma once

#include <map>
#include <vector>

#include "scene/reader/assets.h"
#include "scene/reader/colors.h"
#include "scene/reader/properties.h"
#include "scene/scene_builder.h"

namespace keyhole {

class Context {
  public:
    Context(const Document& scene_document, bool lenient) : document(scene_document) { notes.lenient = lenient; }

    const Document& document;
    Notes notes;
    Assets assets;
    SceneBuilder builder;

    // A BSDF or texture, made once however often it is referred to. Throws InputError for a cycle of references.
    BsdfPtr bsdf(const Element& element);
    std::shared_ptr<const Texture> texture(const Element& element);

    // Tells the builder how many textures there are and how large; each counts once.
    void report_textures();

    // The file that a string parameter names.
    std::string file(Properties& p, const std::string& name) const;

    // Colours and numbers that may be textures.
    ColorInput reflectance(Properties& p, const std::string& name, double fallback);
    ColorInput radiance(Properties& p, const std::string& name, double fallback);
    ScalarInput scalar(Properties& p, const std::string& name, Range range, double fallback);
    // Without textures.
    Spectrum color(Properties& p, const std::string& name, Quantity quantity, const Spectrum& fallback);

  private:
    ColorInput color_input(Properties& p, const std::string& name, Quantity quantity, double fallback);

    std::map<const Element*, BsdfPtr> bsdfs_;
    std::map<const Element*, std::shared_ptr<const Texture>> textures_;
    std::vector<const Element*> open_;  // BSDFs being made, outermost first
};

}  // namespace keyhole
