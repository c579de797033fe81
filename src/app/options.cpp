#include "app/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "base/units.h"

namespace keyhole {
namespace {

std::string range_text(const std::string& type, double min, double max, bool above) {
    if (max < std::numeric_limits<double>::max())
        return fmt::format("{} in {}{}, {}]", type, above ? "(" : "[", min, max);
    return fmt::format("{} {} {}", type, above ? ">" : ">=", min);
}

void add_define(ReaderOptions& reader, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError({}, "'" + text + "' is not a definition; valid: NAME=VALUE, such as width=640");
    reader.defines[text.substr(0, equals)] = text.substr(equals + 1);
}

}  // namespace

CLI::Option* add_parsed(CLI::App& command, const std::string& names, const std::string& type,
                        std::function<void(const std::string&)> read, const std::string& help) {
    const std::string last_name = names.substr(names.rfind(',') + 1);
    const auto checked = [last_name, read = std::move(read)](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            try {
                read(text);
            } catch (const InputError& e) {
                throw InputError({}, last_name + ": " + e.what());
            }
        }
        return true;
    };
    return command.add_option(names, checked, help)->type_name(type)->type_size(1);
}

CLI::Option* add_real(CLI::App& command, const std::string& names, double& target, double min, double max,
                      const std::string& help, bool above) {
    const auto read = [&target, min, max, above](const std::string& text) {
        target = parse_real(text, min, max, above);
    };
    return add_parsed(command, names, range_text("NUMBER", min, max, above), read, help);
}

template <class Integer>
CLI::Option* add_integer(CLI::App& command, const std::string& names, Integer& target, Integer min, Integer max,
                         const std::string& help) {
    const auto read = [&target, min, max](const std::string& text) {
        target = static_cast<Integer>(parse_integer(text, min, max));
    };
    return add_parsed(command, names, "INTEGER", read, help);
}
template CLI::Option* add_integer(CLI::App&, const std::string&, int&, int, int, const std::string&);
template CLI::Option* add_integer(CLI::App&, const std::string&, std::int64_t&, std::int64_t, std::int64_t,
                                  const std::string&);

CLI::Option* add_choice(CLI::App& command, const std::string& names, const std::vector<std::string>& choices,
                        std::function<void(std::size_t)> choose, const std::string& help) {
    std::string type;
    for (const std::string& choice : choices) type += (type.empty() ? "" : "|") + choice;
    const auto read = [choices, choose = std::move(choose)](const std::string& text) {
        const auto found = std::find(choices.begin(), choices.end(), text);
        if (found == choices.end()) throw InputError({}, "unknown name '" + text + "'; " + valid_names(text, choices));
        choose(static_cast<std::size_t>(found - choices.begin()));
    };
    return add_parsed(command, names, type, read, help);
}

std::vector<std::string> split_list(const std::string& list) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        if (end == begin) throw InputError({}, "'" + list + "' has an empty name");
        parts.push_back(list.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

ReconstructionFilter filter_of(const std::string& name) {
    for (const ReconstructionFilter& filter : {make_box_filter(), make_tent_filter(), make_gaussian_filter()})
        if (name == filter.name()) return filter;
    throw InputError({}, "unknown filter '" + name + "'; " + valid_names(name, {"box", "tent", "gaussian"}));
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
    ReaderOptions& reader = options.reader;
    command.add_option("SCENE", options.filename, "Scene file: Mitsuba XML, dialect 0.5/0.6 or 3.x")->required();
    const auto define = [&reader](const std::string& text) { add_define(reader, text); };
    add_parsed(command, "-D,--define", "NAME=VALUE", define,
               "Set a parameter that the scene file uses as $NAME (repeatable)")
        ->take_all();
    const auto size = [&reader](const std::string& text) {
        const auto [width, height] = parse_size(text);
        reader.width = width;
        reader.height = height;
    };
    add_parsed(command, "--size", "WxH", size, "Size of the film in pixels [default: the scene file's]");
    const auto crop = [&reader](const std::string& text) {
        const auto [x, y, width, height] = parse_crop(text);
        reader.override_crop = true;
        reader.crop_x = x;
        reader.crop_y = y;
        reader.crop_width = width;
        reader.crop_height = height;
    };
    add_parsed(command, "--crop", "X,Y,W,H", crop,
               "Render this window of the film only, in pixels from the top left corner");
    const auto filter = [&reader](const std::string& text) { reader.filter = filter_of(text); };
    add_parsed(command, "--filter", "box|tent|gaussian", filter,
               "Reconstruction filter, with its default width [default: the scene file's]");
    command.add_option("--portals", reader.portals,
                       "Scene file of portals, added to the scene: openings that light passes through");
    command.add_flag("--lenient", reader.lenient,
                     "Unknown parameters in the scene file are warnings instead of errors");
}

}  // namespace keyhole
