#include <algorithm>

#include "base/error.h"
#include "strategies/builtin_mix_texts.h"
#include "strategies/mix_file.h"

namespace keyhole {

const std::vector<Mix>& builtin_mixes() {
    static const std::vector<Mix> mixes = [] {
        std::vector<Mix> all;
        for (const BuiltinMixText& file : builtin_mix_texts()) all.push_back(parse_mix(file.text, file.filename));
        std::sort(all.begin(), all.end(), [](const Mix& a, const Mix& b) { return a.name < b.name; });
        return all;
    }();
    return mixes;
}

const Mix& builtin_mix(const std::string& name) {
    const auto& mixes = builtin_mixes();
    const auto found = std::find_if(mixes.begin(), mixes.end(), [&](const Mix& mix) { return mix.name == name; });
    if (found != mixes.end()) return *found;
    std::vector<std::string> names;
    for (const Mix& mix : mixes) names.push_back(mix.name);
    throw InputError({}, "unknown mix '" + name + "'; " + valid_names(name, names) + ", or a file (NAME.toml)");
}

Mix find_mix(const std::string& name_or_file) {
    const bool is_file = name_or_file.ends_with(".toml") || name_or_file.find('/') != std::string::npos;
    return is_file ? read_mix_file(name_or_file) : builtin_mix(name_or_file);
}

}  // namespace keyhole
