// Options shared by the subcommands, and options whose text is read by base/units.h, so that every bad value is
// answered with what would have been valid.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "scene/reader.h"

namespace keyhole {

// Adds an option whose text `read` understands. An InputError of `read` is prefixed with the option's name.
CLI::Option* add_parsed(CLI::App& command, const std::string& names, const std::string& type,
                        std::function<void(const std::string&)> read, const std::string& help);

// A finite number in [min, max], or (min, max] with `above`.
CLI::Option* add_real(CLI::App& command, const std::string& names, double& target, double min, double max,
                      const std::string& help, bool above = false);

// An integer in [min, max].
template <class Integer>
CLI::Option* add_integer(CLI::App& command, const std::string& names, Integer& target, Integer min, Integer max,
                         const std::string& help);

// One of `names`; `choose` receives its index.
CLI::Option* add_choice(CLI::App& command, const std::string& names, const std::vector<std::string>& choices,
                        std::function<void(std::size_t)> choose, const std::string& help);

// SCENE, -D, --lenient, --size, --crop and --filter.
struct SceneOptions {
    std::string filename;
    ReaderOptions reader;
};
void add_scene_options(CLI::App& command, SceneOptions& options);

// "a,b,c" as its parts. Throws InputError for an empty one.
std::vector<std::string> split_list(const std::string& list);

// The filter of a name ("box", "tent", "gaussian") with its default width. Throws InputError for other names.
ReconstructionFilter filter_of(const std::string& name);

}  // namespace keyhole
