// `keyhole sweep`
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/command.h"
#include "app/comparison_options.h"
#include "base/error.h"
#include "base/units.h"

namespace keyhole {
namespace {

constexpr const char* examples = R"(Examples:
  keyhole sweep scenes/cornell-box.xml --mix mmlt-gaussian --vary small-step.sigma=0.001..0.3
      Six steps between the two, evenly in logarithms
  keyhole sweep room.xml --vary large-step.weight=0.05..0.5 --steps 10 -t 10s --runs 5 -o room-large
  keyhole sweep room.xml --vary chains.count=16,128,1024 --equal cpu
)";

struct SweepOptions {
    ComparisonOptions comparison;
    std::string key, values;
    int steps = 6;
};

// "a..b" in steps that are even in logarithms if both are above zero, else even; or "a,b,c" as they are.
std::vector<std::string> listed_values(const std::string& text, int steps) {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos) return split_list(text);
    std::vector<std::string> values;
    constexpr double most = std::numeric_limits<double>::max();
    const double first = parse_real(text.substr(0, dots), -most, most);
    const double last = parse_real(text.substr(dots + 2), -most, most);
    for (int i = 0; i < steps; ++i) {
        const double along = static_cast<double>(i) / (steps - 1);
        const double value =
            first > 0 && last > 0 ? first * std::pow(last / first, along) : std::lerp(first, last, along);
        values.push_back(fmt::format("{:.4g}", value));
    }
    return values;
}

bool is_integer(const Mix& mix, const std::string& key) {
    for (const MixField& field : mix_fields())
        if (field.key() == key) return std::holds_alternative<std::int64_t>(field.get(mix));
    return false;
}

int run(const SweepOptions& options) {
    std::vector<ComparedEntry> entries;
    const Mix base = options.comparison.mix.apply_found(builtin_mix("mmlt"));
    for (std::string text : listed_values(options.values, options.steps)) {
        if (is_integer(base, options.key) && text.find_first_of(".e") != std::string::npos)
            text = fmt::format("{:.0f}", parse_real(text, -1e18, 1e18));
        ComparedEntry entry;
        entry.mix = base;
        apply_settings(entry.mix, {{options.key, text, "--vary"}});
        entry.name = options.key + "=" + text;
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (*end == '\0' && std::isfinite(value)) entry.parameter = {options.key, value};
        if (entries.empty() || entries.back().name != entry.name) entries.push_back(std::move(entry));
    }
    return run_comparison_command(options.comparison, std::move(entries));
}

}  // namespace

void add_sweep_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<SweepOptions>();
    CLI::App* command = keyhole.add_subcommand("sweep", "Measure how a parameter of a mix changes its speed and error");
    add_mix_option(*command, options->comparison.mix, "What is varied", "mmlt");
    const auto vary = [options](const std::string& text) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
            throw InputError({}, "'" + text +
                                     "' is not a range; valid: KEY=FIRST..LAST or KEY=VALUE,VALUE,..., such as "
                                     "small-step.sigma=0.001..0.3");
        options->key = text.substr(0, equals);
        options->values = text.substr(equals + 1);
    };
    add_parsed(*command, "--vary", "KEY=RANGE", vary,
               "A key of the mix, as for --set, and its values: FIRST..LAST, in steps that are even in logarithms if "
               "both are above zero, or VALUE,VALUE,...")
        ->required();
    add_integer(*command, "--steps", options->steps, 2, 1000, "Values of a range [default: 6]");
    add_comparison_options(*command, options->comparison);
    command->footer(std::string(examples) + comparison_footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
