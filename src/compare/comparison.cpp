#include "compare/comparison.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/process.h"
#include "compare/report.h"
#include "compare/results.h"
#include "compare/run_store.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

// Images are kept after 1/64, 1/32, ... of each run.
constexpr std::array doublings = {64, 32, 16, 8, 4, 2};

// Results are made anew when this many times the time of making them has passed.
constexpr double results_interval = 20;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Comparison {
  public:
    Comparison(const Scene& scene, ComparisonPlan plan, const ComparisonCallbacks& callbacks)
        : scene_(scene), plan_(std::move(plan)), callbacks_(callbacks) {
        if (plan_.threads == 0) plan_.threads = tbb::info::default_concurrency();
        require_different_names();
        const std::string program = program_hash();
        for (ComparedEntry& entry : plan_.entries) {
            entry.mix = resolve(scene_of(entry), settings(entry, 0)).mix;
            entry.mix.chain_length = 0;  // the comparison says how long
            stores_.emplace_back(plan_.folder, entry.name, identity(entry, program));
        }
        read_given_reference();
        for (const RunStore& store : stores_) done_.push_back(count_complete(store));
        refuse_or_discard_others();
        fs::create_directories(plan_.folder);
        check_writable(file("results.json"));
    }

    ComparisonOutcome run() {
        warn_of_lengths();
        const Reference reference = find_reference();
        while (!stopped()) {
            const std::size_t e = next_entry();
            if (e == stores_.size()) break;
            make_run(e);
            if (seconds_since(results_made_) > results_interval * results_seconds_) make_files(reference);
        }
        ComparisonOutcome outcome;
        outcome.complete = next_entry() == stores_.size();
        if (!given_reference_ && reference.samples_per_pixel == 0) return outcome;  // stopped at once
        outcome.results = make_files(reference);
        for (const json& warning : outcome.results.at("warnings")) warn(warning);
        return outcome;
    }

  private:
    std::string file(const char* name) const { return (fs::path(plan_.folder) / name).string(); }
    const Scene& scene_of(const ComparedEntry& entry) const { return entry.scene ? *entry.scene : scene_; }
    bool stopped() const { return callbacks_.stop && callbacks_.stop(); }
    void warn(const std::string& message) const {
        if (callbacks_.warn) callbacks_.warn(message);
    }

    void require_different_names() const {
        std::set<std::string> names = {"reference"};  // the page's name of that image
        for (const ComparedEntry& entry : plan_.entries)
            if (!names.insert(entry.name).second)
                throw InputError({}, "two entries of the comparison are called '" + entry.name +
                                         "'; give one of the mixes another name");
    }

    RenderSettings settings(const ComparedEntry& entry, std::uint64_t seed) const {
        RenderSettings s;
        s.integrator = entry.integrator;
        s.mix = entry.mix;
        s.mix.seed = seed;
        s.threads = plan_.threads;
        s.sample_time_split = true;
        (plan_.equal == EqualCost::time  ? s.seconds
         : plan_.equal == EqualCost::cpu ? s.cpu_seconds
                                         : s.mutations_per_pixel) = plan_.budget;
        return s;
    }

    // The seed is that of the comparison: each run makes its own of it.
    json identity(const ComparedEntry& entry, const std::string& program) const {
        json j = {{"scene", hash_text(scene_.content_hash())},
                  {"program", program},
                  {"equal", name_of(plan_.equal)},
                  {"budget", plan_.budget},
                  {"threads", plan_.threads},
                  {"seed", plan_.seed}};
        if (entry.integrator == Integrator::mmlt) {
            j["mix"] = write_mix(entry.mix);
        } else {
            j["integrator"] = integrator_name(entry.integrator);
            j["lengths"] = {entry.mix.lengths.min, entry.mix.lengths.max};
        }
        return j;
    }

    static int count_complete(const RunStore& store) {
        int run = 0;
        while (store.has(run + 1)) ++run;
        return run;
    }

    void refuse_or_discard_others() {
        for (std::size_t e = 0; e < stores_.size(); ++e)
            for (int run = 1; run <= done_[e]; ++run) {
                const std::vector<std::string> differences = stores_[e].differences(run);
                if (differences.empty()) continue;
                if (!plan_.discard)
                    throw InputError({plan_.folder},
                                     fmt::format("holds runs of '{}' that differ from what is asked for now: {}; give "
                                                 "another folder, or --discard to delete those runs",
                                                 plan_.entries[e].name, fmt::join(differences, ", ")));
                stores_[e].discard();
                done_[e] = 0;
            }
    }

    void warn_of_lengths() const {
        const PathLengths& a = plan_.entries.front().mix.lengths;
        for (const ComparedEntry& entry : plan_.entries) {
            const PathLengths& b = entry.mix.lengths;
            if (a.min == b.min && a.max == b.max) continue;
            warn(
                fmt::format("'{}' makes paths of {} to {} edges and '{}' of {} to {}: not the same image (--max-length "
                            "and --min-length set both)",
                            plan_.entries.front().name, a.min, a.max, entry.name, b.min, b.max));
            return;
        }
    }

    void read_given_reference() {
        if (plan_.reference_file.empty()) return;
        given_reference_ = read_reference(plan_.reference_file);
        const Image& image = given_reference_->image;
        const FilmSettings& film = scene_.film();
        if (image.width != film.crop_width || image.height != film.crop_height)
            throw InputError({plan_.reference_file},
                             fmt::format("is {}x{} pixels; the scene's film is {}x{}", image.width, image.height,
                                         film.crop_width, film.crop_height));
    }

    Reference find_reference() const {
        if (given_reference_) return *given_reference_;
        ReferencePlan plan;
        plan.filename = file("reference.exr");
        plan.integrator = plan_.reference_integrator;
        plan.lengths = {plan_.entries.front().mix.lengths.min, 0};
        for (const ComparedEntry& entry : plan_.entries) {
            plan.lengths.min = std::min(plan.lengths.min, entry.mix.lengths.min);
            plan.lengths.max = std::max(plan.lengths.max, entry.mix.lengths.max);
        }
        plan.seconds = plan_.reference_seconds;
        plan.seed = plan_.seed;
        plan.threads = plan_.threads;
        RenderCallbacks callbacks;
        callbacks.stop = callbacks_.stop;
        callbacks.progress = callbacks_.progress;
        return make_reference(scene_, plan, callbacks);
    }

    // The entry whose turn it is, in order: the first of those with the fewest runs; the number of entries if all have
    // as many as asked for.
    std::size_t next_entry() const {
        std::size_t next = stores_.size();
        for (std::size_t e = 0; e < done_.size(); ++e)
            if (done_[e] < plan_.runs && (next == stores_.size() || done_[e] < done_[next])) next = e;
        return next;
    }

    std::uint64_t seed_of(std::size_t e, int run) const {
        Hash hash;
        hash.add(plan_.seed);
        hash.add(plan_.entries[e].name);
        hash.add(static_cast<std::uint64_t>(run));
        return hash.value() >> 1;  // mixes hold seeds below 2^63
    }

    void make_run(std::size_t e) {
        const int run = done_[e] + 1;
        RunRecord record;
        record.seed = seed_of(e, run);
        const RenderSettings s = settings(plan_.entries[e], record.seed);
        const auto keep = [&](RunPart part, const Image& image, const RenderStatistics& statistics) {
            record.parts.push_back(part);
            WriteOptions options;
            if (callbacks_.describe)
                options.metadata = callbacks_.describe(resolve(scene_of(plan_.entries[e]), s), statistics);
            stores_[e].write_image(run, part.part, image, options);
        };
        RenderCallbacks callbacks;
        callbacks.stop = callbacks_.stop;
        callbacks.progress = [&](const Progress& p) { show_progress(e, p); };
        for (const int part : doublings) callbacks.checkpoint_shares.push_back(1.0 / part);
        callbacks.checkpoint = [&](const Checkpoint& c) {
            keep({static_cast<int>(std::lround(1 / c.share)), c.seconds, c.cpu_seconds, c.mutations}, c.image, {});
        };
        RenderResult result = render(scene_of(plan_.entries[e]), s, callbacks);
        if (result.statistics.interrupted) return;
        RenderStatistics& statistics = record.statistics = std::move(result.statistics);
        const double seconds = statistics.seconds_bootstrap + statistics.seconds_render;
        keep({1, seconds, statistics.cpu_seconds, statistics.mutations}, result.image, statistics);
        if (statistics.seconds_render > 0)
            record.mutations_per_second = static_cast<double>(statistics.mutations) / statistics.seconds_render;
        stores_[e].write_record(run, record);
        done_[e] = run;
        seconds_of_runs_ += seconds;
        ++runs_made_;
    }

    // Of the whole comparison, by the mean time of the runs so far.
    void show_progress(std::size_t e, const Progress& of_run) const {
        if (!callbacks_.progress) return;
        int all = 0, done = 0;
        for (const int d : done_) {
            all += std::max(plan_.runs, d);
            done += d;
        }
        Progress p = of_run;
        p.rate = 0;  // mutations and samples in turn say little
        p.phase = fmt::format("run {}/{} {}", done_[e] + 1, plan_.runs, plan_.entries[e].name);
        p.fraction = (done + of_run.fraction) / all;
        p.elapsed = seconds_since(start_);
        const double of_one = plan_.equal == EqualCost::time ? plan_.budget
                              : runs_made_ > 0               ? seconds_of_runs_ / runs_made_
                                                             : of_run.elapsed + std::max(0.0, of_run.remaining);
        p.remaining = of_one * (all - done - of_run.fraction);
        callbacks_.progress(p);
    }

    json make_files(const Reference& reference) {
        const auto begin = Clock::now();
        const json results = make_results(scene_, plan_, reference, stores_, done_);
        std::vector<ReportImage> images = {{"reference", reference.image}};
        for (std::size_t e = 0; e < stores_.size(); ++e)
            if (done_[e] > 0) images.push_back({plan_.entries[e].name, stores_[e].image(1, 1)});
        write_file(file("results.json"), results.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
        write_report(file("index.html"), results, images);
        results_seconds_ = seconds_since(begin);
        results_made_ = Clock::now();
        return results;
    }

    const Scene& scene_;
    ComparisonPlan plan_;
    const ComparisonCallbacks& callbacks_;
    std::vector<RunStore> stores_;  // of the entries
    std::optional<Reference> given_reference_;
    std::vector<int> done_;  // complete runs of the entries
    Clock::time_point start_ = Clock::now(), results_made_ = Clock::now();
    double results_seconds_ = 1;
    double seconds_of_runs_ = 0;
    int runs_made_ = 0;
};

}  // namespace

std::string name_of(EqualCost cost) {
    return cost == EqualCost::time ? "time" : cost == EqualCost::cpu ? "cpu" : "mutations";
}

ComparisonOutcome run_comparison(const Scene& scene, ComparisonPlan plan, const ComparisonCallbacks& callbacks) {
    return Comparison(scene, std::move(plan), callbacks).run();
}

}  // namespace keyhole
