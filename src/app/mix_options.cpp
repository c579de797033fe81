#include "app/mix_options.h"

#include "base/error.h"

namespace keyhole {

Mix MixOptions::apply(Mix base) const {
    if (name) base = find_mix(*name);
    apply_settings(base, settings);
    return base;
}

Mix MixOptions::apply_found(Mix base) const {
    Mix mix = apply(std::move(base));
    if (mix.tuning != Mix::Tuning::off)
        throw InputError({}, "the mix '" + mix.name +
                                 "' is found by a race in a render; valid: a mix without tuning, such as the .mix.toml "
                                 "file that such a render writes");
    return mix;
}

CLI::Option* add_set_option(CLI::App& command, std::function<void(const Setting&)> take) {
    const auto set = [take = std::move(take)](const std::string& text) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError({}, "'" + text + "' is not a setting; valid: KEY=VALUE, such as small-step.s2=0.05");
        take({text.substr(0, equals), text.substr(equals + 1), "--set"});
    };
    return add_parsed(command, "--set", "KEY=VALUE", set,
                      "Change a key of the mix, such as small-step.s2=0.05, large-step.weight=0.3 or "
                      "lengths.per-chain=fixed (repeatable)")
        ->take_all();
}

CLI::Option* add_mix_option(CLI::App& command, MixOptions& options, const std::string& help,
                            const std::string& fallback) {
    const auto mix = [&options](const std::string& text) { options.name = text; };
    return add_parsed(command, "--mix", "NAME|FILE", mix,
                      help + ": a mix that `keyhole mixes` lists, or a file (.toml) [default: " + fallback + "]");
}

std::vector<CLI::Option*> add_mix_options(CLI::App& command, MixOptions& options, const std::string& fallback) {
    return {add_mix_option(command, options, "How the chains move", fallback),
            add_set_option(command, [&options](const Setting& s) { options.settings.push_back(s); })};
}

CLI::Option* add_mix_key(CLI::App& command, MixOptions& options, const std::string& name, const std::string& key,
                         const std::string& help) {
    const auto set = [&options, name, key](const std::string& text) { options.settings.push_back({key, text, name}); };
    return add_parsed(command, name, "INTEGER", set, help);
}

}  // namespace keyhole
