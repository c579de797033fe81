#include "compare/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/units.h"
#include "base/vec.h"
#include "compare/error_split.h"
#include "compare/metrics.h"
#include "compare/speed_up.h"
#include "compare/tradeoff.h"
#include "compare/warnings.h"

namespace keyhole {
namespace {

using nlohmann::json;

// The relMSE of a reference should be small against that of what it judges.
constexpr double largest_reference_share = 0.1;

struct EntryRuns {
    std::vector<RunRecord> records;
    std::vector<int> parts;  // that all runs have, from the shortest to 1
};

EntryRuns load(const RunStore& store, int runs) {
    EntryRuns entry;
    for (int run = 1; run <= runs; ++run) entry.records.push_back(store.record(run));
    if (entry.records.empty()) return entry;
    for (const RunPart& p : entry.records.front().parts) {
        const auto has_part = [&p](const RunRecord& r) {
            return std::any_of(r.parts.begin(), r.parts.end(), [&p](const RunPart& q) { return q.part == p.part; });
        };
        if (std::all_of(entry.records.begin(), entry.records.end(), has_part)) entry.parts.push_back(p.part);
    }
    return entry;
}

// Over the runs of an entry.
template <class Value>
std::vector<double> collect(const EntryRuns& entry, const Value& value) {
    std::vector<double> values;
    for (const RunRecord& record : entry.records) values.push_back(value(record));
    return values;
}

double mean_of_part(const EntryRuns& entry, int part, double (*value)(const RunPart&)) {
    return estimate_mean(collect(entry,
                                 [&](const RunRecord& r) {
                                     return value(*std::find_if(r.parts.begin(), r.parts.end(),
                                                                [part](const RunPart& p) { return p.part == part; }));
                                 }))
        .mean;
}

// What the images of all runs at one part of the budget say.
struct PointResults {
    std::vector<ErrorMetrics> metrics;  // by run
    std::optional<ErrorSplit> split;    // of two runs or more

    Estimate estimate(double (*value)(const ErrorMetrics&)) const {
        std::vector<double> values;
        for (const ErrorMetrics& m : metrics) values.push_back(value(m));
        return estimate_mean(values);
    }
};

PointResults judge(const RunStore& store, int runs, int part, const Reference& reference) {
    PointResults point;
    std::vector<Image> images(static_cast<std::size_t>(runs));
    point.metrics.resize(images.size());
    parallel_for(images.size(), [&](std::size_t i) {
        images[i] = store.image(static_cast<int>(i) + 1, part);
        point.metrics[i] = compare_images(images[i], reference.image);
    });
    if (runs > 1)
        point.split = split_error(images, reference.image, reference.variance ? &*reference.variance : nullptr);
    return point;
}

double relmse(const ErrorMetrics& m) { return sqr(m.rrmse); }

json metrics_json(const PointResults& point) {
    json metrics = {{"relmse", to_json(point.estimate(relmse))}};
    for (const MetricInfo& metric : metric_list()) {
        std::vector<double> values;
        for (const ErrorMetrics& m : point.metrics) values.push_back(m.*metric.value);
        metrics[metric.name] = to_json(estimate_mean(values));
    }
    return metrics;
}

json split_json(const ErrorSplit& split) {
    return {{"variance", to_json(split.variance)}, {"squared_bias", to_json(split.squared_bias)}};
}

json point_json(const EntryRuns& entry, int part, const PointResults& point) {
    json j = {
        {"seconds", mean_of_part(entry, part, [](const RunPart& p) { return p.seconds; })},
        {"cpu_seconds", mean_of_part(entry, part, [](const RunPart& p) { return p.cpu_seconds; })},
        {"mutations", mean_of_part(entry, part, [](const RunPart& p) { return static_cast<double>(p.mutations); })},
        {"relmse", to_json(point.estimate(relmse))}};
    if (point.split) j.update(split_json(*point.split));
    return j;
}

// By name, as they are first seen: where mixes are tuned, runs may have different ones.
json strategies_json(const EntryRuns& entry) {
    std::vector<StrategyStatistics> sums;
    for (const RunRecord& record : entry.records)
        for (const StrategyStatistics& s : record.statistics.strategies) {
            auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.name == s.name; });
            if (found == sums.end()) {
                sums.emplace_back().name = s.name;
                found = sums.end() - 1;
            }
            StrategyStatistics& sum = *found;
            sum.proposals += s.proposals;
            sum.accepted += s.accepted;
            sum.mean_acceptance += s.mean_acceptance * static_cast<double>(s.proposals);
            sum.luminance.effective_sample_size += s.luminance.effective_sample_size;
            for (const auto& [kind, count] : s.failures) sum.failures[kind] += count;
        }
    json strategies = json::array();
    for (StrategyStatistics& sum : sums) {
        if (sum.proposals > 0) sum.mean_acceptance /= static_cast<double>(sum.proposals);
        json j = {{"name", sum.name},
                  {"proposals", sum.proposals},
                  {"accepted", sum.accepted},
                  {"mean_acceptance", sum.mean_acceptance},
                  {"failures", sum.failures}};
        if (const double samples = sum.luminance.effective_sample_size; samples > 0) {
            j["effective_sample_size"] = samples;
            j["autocorrelation_time"] = static_cast<double>(sum.proposals) / samples;
        }
        strategies.push_back(std::move(j));
    }
    return strategies;
}

json time_split_json(const EntryRuns& entry) {
    std::map<std::string, double> split;
    double known = 0;
    for (const RunRecord& record : entry.records) {
        for (const auto& [phase, share] : record.statistics.time_split) split[phase] += share;
        known += !record.statistics.time_split.empty();
    }
    for (auto& [phase, share] : split) share /= known;
    return split;
}

json entry_head(const ComparedEntry& entry, int runs) {
    const bool mix = entry.integrator == Integrator::mmlt;
    json j = {{"name", entry.name}, {"kind", mix ? "mix" : "integrator"}, {"runs", runs}};
    if (mix) {
        j["mix"] = write_mix(entry.mix);
        if (!entry.mix.description.empty()) j["description"] = entry.mix.description;
    }
    if (entry.parameter) j["parameter"] = {{"name", entry.parameter->name}, {"value", entry.parameter->value}};
    if (entry.knob) j["knob"] = {{"name", entry.knob->name}, {"value", entry.knob->value}};
    return j;
}

// What a speed-up is made from. The relMSE is what is left without that of the reference.
Converging converging(const json& entry, const PointResults& last, EqualCost equal, double reference_relmse) {
    constexpr double nothing = 1e-30;  // a run without any error
    Converging c;
    for (const json& point : entry.at("convergence"))
        c.curve.push_back({point.at(equal == EqualCost::cpu ? "cpu_seconds" : "seconds"),
                           std::max(nothing, point.at("relmse").at("mean").get<double>() - reference_relmse)});
    for (const ErrorMetrics& m : last.metrics)
        c.relmse_of_runs.push_back(std::max(nothing, relmse(m) - reference_relmse));
    return c;
}

json scene_json(const Scene& scene, const ComparisonPlan& plan) {
    int longest = 0;
    for (const ComparedEntry& entry : plan.entries) longest = std::max(longest, entry.mix.lengths.max);
    return {{"file", plan.scene_file},
            {"name", plan.scene_name},
            {"hash", hash_text(scene.content_hash())},
            {"width", scene.film().crop_width},
            {"height", scene.film().crop_height},
            {"max_length", longest}};
}

json reference_json(const ComparisonPlan& plan, const Reference& reference, double own_relmse) {
    namespace fs = std::filesystem;
    const fs::path file = fs::absolute(reference.filename).lexically_relative(fs::absolute(plan.folder));
    json j = {{"file", file.empty() ? reference.filename : file.string()}};
    if (!reference.integrator.empty()) {
        j["integrator"] = reference.integrator;
        j["samples_per_pixel"] = reference.samples_per_pixel;
        j["seconds"] = reference.seconds;
    }
    if (reference.variance) j["relmse"] = own_relmse;
    return j;
}

// Share of the reference's values whose standard error is more than half of sqrt(R^2 + epsilon mean(R)^2): what errors
// are divided by is chance there.
double unreliable_share(const Reference& reference) {
    double mean = 0, unreliable = 0;
    const double count = static_cast<double>(reference.image.rgb.size());
    for (const float v : reference.image.rgb) mean += v / count;
    for (std::size_t i = 0; i < reference.image.rgb.size(); ++i)
        unreliable +=
            reference.variance->rgb[i] > 0.25 * (sqr(double{reference.image.rgb[i]}) + metric_epsilon * sqr(mean));
    return unreliable / count;
}

std::vector<std::string> reference_warnings(const Reference& reference, double own_relmse, double smallest_relmse) {
    if (!reference.variance)
        return {"how noisy the reference is is not known: its noise counts as bias of every entry"};
    if (const double share = unreliable_share(reference); share > 0.01)
        return {
            fmt::format("the standard error of the reference is more than half its value in {:.0f}% of its values: "
                        "relative errors and biases mean little there; give it more time (--reference-time)",
                        100 * share)};
    if (own_relmse > largest_reference_share * smallest_relmse)
        return {
            fmt::format("the reference has a relMSE of {:.2g}, more than {:.0f}% of that of an entry ({:.2g}); give it "
                        "more time (--reference-time)",
                        own_relmse, 100 * largest_reference_share, smallest_relmse)};
    return {};
}

}  // namespace

json make_results(const Scene& scene, const ComparisonPlan& plan, const Reference& reference,
                  const std::vector<RunStore>& stores, const std::vector<int>& runs) {
    const double own_relmse = reference.variance ? reference_relmse(reference.image, *reference.variance) : 0;
    json results = {{"format", "keyhole-results"},
                    {"version", 1},
                    {"keyhole", plan.program},
                    {"machine", machine_name()},
                    {"created", utc_now()},
                    {"command", plan.command},
                    {"equal", name_of(plan.equal)},
                    {"budget", plan.budget},
                    {"runs", plan.runs},
                    {"threads", plan.threads},
                    {"seed", plan.seed},
                    {"scene", scene_json(scene, plan)},
                    {"reference", reference_json(plan, reference, own_relmse)},
                    {"entries", json::array()}};
    std::optional<Converging> first;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < stores.size(); ++e) {
        json j = entry_head(plan.entries[e], runs[e]);
        const EntryRuns entry = load(stores[e], runs[e]);
        if (!entry.parts.empty()) {
            PointResults point;
            j["convergence"] = json::array();
            for (const int part : entry.parts) {
                point = judge(stores[e], runs[e], part, reference);
                j["convergence"].push_back(point_json(entry, part, point));
            }
            j["metrics"] = metrics_json(point);  // of the last point: the whole budget
            if (point.split) j["split"] = split_json(*point.split);
            j["strategies"] = strategies_json(entry);
            j["mutations_per_second"] =
                to_json(estimate_mean(collect(entry, [](const RunRecord& r) { return r.mutations_per_second; })));
            j["time_split"] = time_split_json(entry);
            j["warnings"] = warnings_of(entry.records);
            const Converging c = converging(j, point, plan.equal, own_relmse);
            smallest = std::min(smallest, c.curve.back().relmse);
            if (e == 0)
                first = c;
            else if (first)
                j["speed_up"] = to_json(speed_up(*first, c));
        }
        results["entries"].push_back(std::move(j));
    }
    if (!plan.knobs.empty()) results["tradeoff"] = make_tradeoff(results, plan.knobs);
    results["warnings"] = reference_warnings(reference, own_relmse, smallest);
    return results;
}

}  // namespace keyhole
