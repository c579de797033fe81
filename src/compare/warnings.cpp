#include "compare/warnings.h"

#include <fmt/format.h>

#include <map>
#include <regex>

namespace keyhole {
namespace {

struct Given {
    std::string first;
    int runs = 0;
    bool differs = false;
};

std::string without_figures(const std::string& text) {
    static const std::regex figure("[0-9][0-9.]*(e[+-]?[0-9]+)?");
    return std::regex_replace(text, figure, "#");
}

}  // namespace

std::vector<std::string> warnings_of(std::span<const RunRecord> runs) {
    std::map<std::string, Given> all;  // by the text without its figures
    for (const RunRecord& run : runs)
        for (const std::string& warning : run.statistics.warnings) {
            Given& given = all[without_figures(warning)];
            if (++given.runs == 1) given.first = warning;
            given.differs = given.differs || given.first != warning;
        }
    std::vector<std::string> warnings;
    for (const auto& [text, given] : all)
        warnings.push_back(runs.size() == 1 ? given.first
                                            : fmt::format("{} ({} of {} runs{})", given.first, given.runs, runs.size(),
                                                          given.differs ? "; figures of the first" : ""));
    return warnings;
}

}  // namespace keyhole
