// `keyhole compare`
#include <memory>

#include "app/command.h"
#include "app/comparison_options.h"
#include "app/report.h"
#include "base/error.h"

namespace keyhole {
namespace {

constexpr const char* examples = R"(Examples:
  keyhole compare scenes/cornell-box.xml --mixes mmlt,mmlt-gaussian
      Ten runs of a minute of each mix, against ten minutes of bdpt
  keyhole compare room.xml --mixes mmlt,mine.toml --integrators path,bdpt -t 10s --runs 5 -o room
      A mix of your own as well, and two integrators without chains
  keyhole compare room.xml --mixes mmlt,mine.toml --equal cpu --reference ref.exr
      At equal processor time, against an image made before
)";

struct CompareOptions {
    ComparisonOptions comparison;
    std::vector<std::string> mixes;  // names and files
    std::vector<Integrator> integrators;
};

int run(const CompareOptions& options) {
    std::vector<ComparedEntry> entries;
    for (const std::string& name : options.mixes) {
        ComparedEntry entry;
        entry.mix = find_mix(name);
        apply_settings(entry.mix, options.comparison.mix.settings);
        entry.name = entry.mix.name;
        entries.push_back(std::move(entry));
    }
    for (const Integrator integrator : options.integrators)
        entries.push_back(integrator_entry(options.comparison, integrator));
    if (entries.empty()) throw InputError({}, "nothing to compare: give --mixes, --integrators or both");
    return run_comparison_command(options.comparison, std::move(entries));
}

}  // namespace

void add_compare_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = keyhole.add_subcommand("compare", "Measure which mixes render a scene best, at equal time");
    const auto mixes = [options](const std::string& text) {
        for (const std::string& name : split_list(text)) options->mixes.push_back(name);
    };
    add_parsed(*command, "--mixes", "NAME|FILE,...", mixes,
               "Mixes to compare: built-in ones (keyhole mixes) or files (.toml); speed-ups are over the first entry")
        ->take_all();
    const auto integrators = [options](const std::string& text) {
        for (const std::string& name : split_list(text)) {
            const Integrator integrator = integrator_of(name);
            if (integrator == Integrator::mmlt) throw InputError({}, "'mmlt' is a mix: --mixes mmlt");
            options->integrators.push_back(integrator);
        }
    };
    add_parsed(*command, "--integrators", "path,bdpt", integrators, "Integrators without chains to compare as well")
        ->take_all();
    add_comparison_options(*command, options->comparison);
    command->footer(std::string(examples) + comparison_footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
