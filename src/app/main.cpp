// The `keyhole` command.
#include <fcntl.h>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include "app/command.h"
#include "app/console.h"
#include "app/version.h"
#include "base/error.h"

namespace keyhole {
namespace {

constexpr const char* footer = R"(Begin with:  keyhole render SCENE        (keyhole render --help has examples)

Exit codes: 0 done; 1 failure while running; 2 options or input not valid;
128 + signal number when a signal ended the run.)";

std::string version_text() {
    const nlohmann::ordered_json all = versions();
    std::string text;
    for (const auto& [name, value] : all.items())
        text += fmt::format("{}{} {}", text.empty() ? "" : "\n", name, value.get<std::string>());
    return text;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<std::string> command_names(const CLI::App& parent) {
    std::vector<std::string> names;
    for (const CLI::App* command : parent.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

// What is wrong with the command line, and what would have been valid.
std::string explain(const CLI::App& keyhole, const CLI::ParseError& error) {
    const CLI::App* chosen = &keyhole;
    std::string name_of_chosen = "keyhole";
    while (!chosen->get_subcommands().empty()) {
        chosen = chosen->get_subcommands().front();
        name_of_chosen += " " + chosen->get_name();
    }
    const CLI::App& command = *chosen;
    const std::vector<std::string> extras = keyhole.remaining(true);
    const std::string hint = fmt::format("\n'{} --help' explains the options", name_of_chosen);
    if (extras.empty()) return error.what() + hint;
    const std::string& extra = extras.front();
    if (extra.starts_with("-")) {
        const std::string name = extra.substr(0, extra.find('='));
        return fmt::format("unknown option '{}'; {}", name, valid_names(name, option_names(command))) + hint;
    }
    if (const std::vector<std::string> names = command_names(command); !names.empty())
        return fmt::format("unknown command '{}'; {}", extra, valid_names(extra, names)) + hint;
    return fmt::format("one argument too many: '{}'", extra) + hint;
}

int run(int argc, char** argv) {
    CLI::App keyhole("Keyhole: Metropolis light transport for scenes that light can hardly get into", "keyhole");
    Runner runner;
    keyhole.require_subcommand(0, 1);
    keyhole.set_version_flag("--version", version_text(), "Print the versions of Keyhole and its libraries, and exit");
    keyhole.footer(footer);
    add_render_command(keyhole, runner);
    add_compare_command(keyhole, runner);
    add_sweep_command(keyhole, runner);
    add_tradeoff_command(keyhole, runner);
    add_diff_command(keyhole, runner);
    add_info_command(keyhole, runner);
    add_bench_command(keyhole, runner);
    add_mixes_command(keyhole, runner);
    add_roundtrip_command(keyhole, runner);
    add_portals_command(keyhole, runner);
    add_cones_command(keyhole, runner);
    add_trace_command(keyhole, runner);
    add_experiment_command(keyhole, runner);
    try {
        keyhole.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return keyhole.exit(e);  // --help, --version
        print_error(explain(keyhole, e));
        return exit_bad_input;
    }
    if (!runner) {
        print_error("no command given\n\n" + keyhole.help());
        return exit_bad_input;
    }
    return runner();
}

// The first file that is opened would otherwise become the stream that was closed, and messages end up in it.
void open_standard_streams() {
    for (const int stream : {0, 1, 2})
        if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDWR);
}

}  // namespace
}  // namespace keyhole

int main(int argc, char** argv) {
    keyhole::open_standard_streams();
    try {
        const int code = keyhole::run(argc, argv);
        if (code != 0 || std::fflush(stdout) == 0) return code;
        keyhole::print_error("cannot write to the standard output");
    } catch (const keyhole::InputError& e) {
        keyhole::print_error(e.what());
        return keyhole::exit_bad_input;
    } catch (const std::invalid_argument& e) {  // settings that render() refuses
        keyhole::print_error(e.what());
        return keyhole::exit_bad_input;
    } catch (const std::bad_alloc&) {
        keyhole::print_error("out of memory");
    } catch (const std::exception& e) {
        keyhole::print_error(e.what());
    }
    return keyhole::exit_failure;
}
