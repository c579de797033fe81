// Options that choose and change a strategy mix, and their effect.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "strategies/mix_file.h"

namespace keyhole {

struct MixOptions {
    std::optional<std::string> name;  // --mix: a built-in mix or a file
    std::vector<Setting> settings;    // in the order of the command line

    // The mix `base`, or the one of --mix in its place, with the settings. Throws InputError.
    Mix apply(Mix base) const;
    // The same, for what has no use for a mix that is yet to be found.
    Mix apply_found(Mix base) const;
};

// --set alone.
CLI::Option* add_set_option(CLI::App& command, std::function<void(const Setting&)> take);

// --mix alone; `help` says of what, `fallback` is the default.
CLI::Option* add_mix_option(CLI::App& command, MixOptions& options, const std::string& help,
                            const std::string& fallback);

// --mix and --set. `options` must live until the command line has been parsed.
std::vector<CLI::Option*> add_mix_options(CLI::App& command, MixOptions& options, const std::string& fallback = "mmlt");

// An option that stands for `--set KEY=VALUE`.
CLI::Option* add_mix_key(CLI::App& command, MixOptions& options, const std::string& name, const std::string& key,
                         const std::string& help);

}  // namespace keyhole
