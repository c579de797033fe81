// Films, reconstruction filters and samplers.
#include "scene/reader.h"
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

constexpr int largest_film = 65536;

ReconstructionFilter box(Properties& p) { return make_box_filter(p.number("radius", {0.1, 100}, 0.5)); }
ReconstructionFilter tent(Properties& p) { return make_tent_filter(p.number("radius", {0.1, 100}, 1)); }
ReconstructionFilter gaussian(Properties& p) {
    const double stddev = p.number("stddev", {0.05, 25}, 0.5);
    return make_gaussian_filter(stddev, 4 * stddev);  // Mitsuba's radius
}

ReconstructionFilter read_filter(const Element& element, Context& context) {
    Properties p(element, context.document, context.notes);
    const ReconstructionFilter filter = find_plugin(filter_plugins(), element)(p);
    p.finish();
    return filter;
}

void check_crop(const FilmSettings& film, const SourceLocation& where) {
    const auto inside = [](int offset, int size, int whole) {
        return offset >= 0 && size > 0 && offset < whole && size <= whole - offset;
    };
    if (inside(film.crop_x, film.crop_width, film.width) && inside(film.crop_y, film.crop_height, film.height)) return;
    throw InputError(where, "the crop window of " + std::to_string(film.crop_width) + "x" +
                                std::to_string(film.crop_height) + " pixels at " + std::to_string(film.crop_x) + ", " +
                                std::to_string(film.crop_y) + " is not inside the film of " +
                                std::to_string(film.width) + "x" + std::to_string(film.height));
}

void set_size(FilmSettings& film, int width, int height) {
    film.width = film.crop_width = width;
    film.height = film.crop_height = height;
    film.crop_x = film.crop_y = 0;
}

void read_size(Properties& p, FilmSettings& film) {
    const int width = p.integer("width", 1, largest_film, 768);
    set_size(film, width, p.integer("height", 1, largest_film, 576));
    film.crop_x = p.integer("crop_offset_x", 0, largest_film, 0);
    film.crop_y = p.integer("crop_offset_y", 0, largest_film, 0);
    film.crop_width = p.integer("crop_width", 1, largest_film, film.width);
    film.crop_height = p.integer("crop_height", 1, largest_film, film.height);
    check_crop(film, p.element().where);
}

void read_hdr_film(Properties& p, Context& context, FilmSettings& film) {
    read_size(p, film);
    if (const auto* filter = p.object("rfilter")) film.filter = read_filter(*filter->target, context);
    p.ignore({"file_format", "pixel_format", "component_format", "banner", "attach_log", "high_quality_edges",
              "sample_border", "compensate"});
}

void read_ldr_film(Properties& p, Context& context, FilmSettings& film) {
    read_hdr_film(p, context, film);
    p.ignore({"tonemap_method", "gamma", "exposure", "key", "burn"});
}

using FilmReader = void (*)(Properties&, Context&, FilmSettings&);

const Plugins<FilmReader>& film_plugins() {
    static const Plugins<FilmReader> all = {{"hdrfilm", read_hdr_film}, {"ldrfilm", read_ldr_film}};
    return all;
}

// What the command line says about the film.
void override_film(FilmSettings& film, const ReaderOptions& options, Context& context) {
    const SourceLocation scene{context.document.filename};
    if (options.width < 0 || options.width > largest_film || options.height < 0 || options.height > largest_film)
        throw InputError(scene, "a film of " + std::to_string(options.width) + "x" + std::to_string(options.height) +
                                    " pixels: each must be between 1 and " + std::to_string(largest_film));
    if (options.width > 0 || options.height > 0) {
        const bool cropped = film.crop_width != film.width || film.crop_height != film.height;
        if (cropped && !options.override_crop)
            context.notes.warnings.emplace_back(
                "the scene's crop window is ignored because the film's size is replaced");
        set_size(film, options.width > 0 ? options.width : film.width,
                 options.height > 0 ? options.height : film.height);
    }
    if (options.override_crop) {
        film.crop_x = options.crop_x;
        film.crop_y = options.crop_y;
        film.crop_width = options.crop_width;
        film.crop_height = options.crop_height;
        check_crop(film, scene);
    }
    if (options.filter) film.filter = *options.filter;
}

}  // namespace

const Plugins<FilterMaker>& filter_plugins() {
    static const Plugins<FilterMaker> all = {{"box", box}, {"tent", tent}, {"gaussian", gaussian}};
    return all;
}

FilmSettings read_film(const Element* film, Context& context, const ReaderOptions& options) {
    FilmSettings settings;
    settings.filter = make_gaussian_filter();
    if (film) {
        Properties p(*film, context.document, context.notes);
        find_plugin(film_plugins(), *film)(p, context, settings);
        p.finish();
    }
    override_film(settings, options, context);
    return settings;
}

void note_sampler(const Element& sampler, Context& context) {
    static const Plugins<int> known = {{"independent", 0}, {"stratified", 0}, {"multijitter", 0}, {"orthogonal", 0},
                                       {"ldsampler", 0},   {"halton", 0},     {"hammersley", 0},  {"sobol", 0}};
    find_plugin(known, sampler);
    Notes of_parameters;  // one line for the sampler is enough
    of_parameters.lenient = context.notes.lenient;
    Properties p(sampler, context.document, of_parameters);
    p.ignore({"sample_count", "seed", "dimension", "scramble", "jitter", "strength", "wrap"});
    p.finish();
    context.notes.warnings.insert(context.notes.warnings.end(), of_parameters.warnings.begin(),
                                  of_parameters.warnings.end());
    context.notes.unused.push_back(p.title() + " has no effect (" + place_text(sampler.where) + ")");
}

}  // namespace keyhole
