#include "compare/run_store.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"

namespace keyhole {

using nlohmann::json;
namespace fs = std::filesystem;

// What the results need of a strategy.
void to_json(json& j, const StrategyStatistics& s) {
    j = {{"name", s.name},
         {"proposals", s.proposals},
         {"accepted", s.accepted},
         {"mean_acceptance", s.mean_acceptance},
         {"failures", s.failures},
         {"effective_sample_size", s.luminance.effective_sample_size}};
}
void from_json(const json& j, StrategyStatistics& s) {
    j.at("name").get_to(s.name);
    j.at("proposals").get_to(s.proposals);
    j.at("accepted").get_to(s.accepted);
    j.at("mean_acceptance").get_to(s.mean_acceptance);
    j.at("failures").get_to(s.failures);
    j.at("effective_sample_size").get_to(s.luminance.effective_sample_size);
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunPart, part, seconds, cpu_seconds, mutations)

namespace {

// A name for a folder: the entry's own where that is plain, else with a hash of it.
std::string folder_name(const std::string& entry) {
    std::string name;
    for (const char c : entry)
        name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '=' ? c
                : c == '.' && !name.empty()                                                     ? c
                                                                                                : '_';
    if (name == entry) return name;
    Hash hash;
    hash.add(entry);
    return name + "-" + hash_text(hash.value()).substr(0, 8);
}

json read_json(const std::string& filename) {
    std::ifstream file(filename);
    if (!file) throw InputError({filename}, "cannot be read");
    try {
        return json::parse(file);
    } catch (const json::exception& e) {
        throw InputError({filename}, std::string("is not a record of a run: ") + e.what());
    }
}

std::string short_text(const json& value) {
    const std::string text = value.dump();
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

}  // namespace

RunStore::RunStore(const std::string& folder, const std::string& entry, json identity)
    : folder_(folder),
      entry_folder_((fs::path("runs") / folder_name(entry)).string()),
      identity_(std::move(identity)) {}

std::string RunStore::record_file(int run) const {
    return (fs::path(folder_) / entry_folder_ / fmt::format("run-{}.json", run)).string();
}

std::string RunStore::image_name(int run, int part) const {
    const std::string name = part == 1 ? fmt::format("run-{}.exr", run) : fmt::format("run-{}-1of{}.exr", run, part);
    return (fs::path(entry_folder_) / name).string();
}

bool RunStore::has(int run) const { return fs::exists(record_file(run)); }

std::vector<std::string> RunStore::differences(int run) const {
    const json there = read_json(record_file(run)).value("identity", json::object());
    std::vector<std::string> result;
    for (const auto& [key, value] : identity_.items())
        if (const json old = there.value(key, json()); old != value)
            result.push_back(fmt::format("{} ({} there, {} now)", key, short_text(old), short_text(value)));
    return result;
}

RunRecord RunStore::record(int run) const {
    const json j = read_json(record_file(run));
    RunRecord record;
    try {
        record.seed = j.at("seed");
        record.parts = j.at("parts").get<std::vector<RunPart>>();
        record.mutations_per_second = j.at("mutations_per_second");
        RenderStatistics& s = record.statistics;
        s.strategies = j.at("strategies").get<std::vector<StrategyStatistics>>();
        s.time_split = j.at("time_split").get<std::map<std::string, double>>();
        s.warnings = j.at("warnings").get<std::vector<std::string>>();
    } catch (const json::exception& e) {
        throw InputError({record_file(run)}, std::string("is not a record of a run: ") + e.what());
    }
    if (record.parts.empty()) throw InputError({record_file(run)}, "is a record of a run without images");
    return record;
}

Image RunStore::image(int run, int part) const {
    return read_image((fs::path(folder_) / image_name(run, part)).string());
}

void RunStore::write_image(int run, int part, const Image& image, const WriteOptions& options) const {
    fs::create_directories(fs::path(folder_) / entry_folder_);
    keyhole::write_image((fs::path(folder_) / image_name(run, part)).string(), image, options);
}

void RunStore::write_record(int run, const RunRecord& record) const {
    const RenderStatistics& s = record.statistics;
    const json j = {{"identity", identity_},      {"seed", record.seed},
                    {"parts", record.parts},      {"mutations_per_second", record.mutations_per_second},
                    {"strategies", s.strategies}, {"time_split", s.time_split},
                    {"warnings", s.warnings}};
    write_file(record_file(run), j.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

void RunStore::discard() const { fs::remove_all(fs::path(folder_) / entry_folder_); }

}  // namespace keyhole
