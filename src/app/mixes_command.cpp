// `keyhole mixes`
#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(
A mix says how the chains of a render move. To make one of your own:
  keyhole mixes show mmlt > mine.toml
  keyhole render SCENE --mix mine.toml

Exit codes: 0 done; 2 the mix is not there or not valid.)";

void list_mixes() {
    for (const Mix& mix : builtin_mixes()) fmt::print("{:<16} {}\n", mix.name, mix.description);
}

std::string default_text(const Parameter& p) { return to_toml(p, p.fallback); }

std::string effect_text(const Parameter& p) {
    return p.needs.empty() ? "" : fmt::format(" (with {} = \"{}\")", p.needs, p.needed_value);
}

void print_strategies() {
    for (const StrategyInfo& s : strategy_registry()) {
        fmt::print("{}\n  {}{}\n", s.name, s.description, s.ergodic ? "; reaches every path" : "");
        for (const Parameter& p : s.parameters)
            fmt::print("  {:<8} {}{}: {} [default: {}]\n", p.name, p.description, effect_text(p), valid_values(p),
                       default_text(p));
    }
}

void print_row(const std::string& key, const Parameter& p) {
    fmt::print("| `{}` | {} | {} | `{}` |\n", key, p.description + effect_text(p), valid_values(p), default_text(p));
}

// The part of docs/mix-files.md that is made from the code.
void print_markdown() {
    fmt::print("### Keys of the file\n\n| key | meaning | values | default |\n|---|---|---|---|\n");
    for (const MixField& field : mix_fields()) print_row(field.key(), field.parameter);
    for (const StrategyInfo& s : strategy_registry()) {
        fmt::print("\n### `{}`\n\n{}.{}\n", s.name, s.description, s.ergodic ? " Reaches every path." : "");
        if (s.parameters.empty()) continue;
        fmt::print("\n| key | meaning | values | default |\n|---|---|---|---|\n");
        for (const Parameter& p : s.parameters) print_row(p.name, p);
    }
}

}  // namespace

void add_mixes_command(CLI::App& keyhole, Runner& runner) {
    CLI::App* command = keyhole.add_subcommand("mixes", "List, print and explain strategy mixes");
    command->require_subcommand(0, 1);
    command->footer(footer);
    CLI::App* show = command->add_subcommand("show", "Print a mix as a file");
    CLI::App* strategies = command->add_subcommand("strategies", "Explain the strategies that a mix may hold");
    const auto name = std::make_shared<std::string>();
    show->add_option("MIX", *name, "A mix that `keyhole mixes` lists, or a file (.toml)")->required();
    const auto markdown = std::make_shared<bool>(false);
    strategies->add_flag("--markdown", *markdown, "As the tables of docs/mix-files.md");
    command->callback([=, &runner] {
        runner = [=] {
            if (show->parsed())
                fmt::print("{}", write_mix(find_mix(*name)));
            else if (!strategies->parsed())
                list_mixes();
            else
                *markdown ? print_markdown() : print_strategies();
            return exit_success;
        };
    });
}

}  // namespace keyhole
