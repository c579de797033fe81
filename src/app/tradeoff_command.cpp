// `keyhole tradeoff`
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "app/command.h"
#include "app/comparison_options.h"
#include "base/error.h"

namespace keyhole {
namespace {

constexpr const char* examples = R"(Every knob of a mix is turned to its other settings, one at a time. For each: the
time of a mutation, variance, squared bias and efficiency, 1 / (CPU time x relMSE);
a picture of time against error; and one line of conclusion made from the figures.

  large-step     share of large steps
  swap-interval  mutations between changes of technique
  steps          sizes of all small steps and perturbations, as a factor
  cones          how the room about edges is found (mixes with cones)
  rectification  what follows a proposal that fails
  target         what a path counts as
  chains         their number; their length is the rest of the time
  bootstrap      samples before the first mutation
  starts         largest share of the chains that start from one of them
  max-length     longest paths: fewer are faster, and light is missing
  robust         watertight ray queries

Examples:
  keyhole tradeoff scenes/ajar-door.xml -o out/ajar-door --equal cpu -t 10s --runs 5
  keyhole tradeoff room.xml --mix fused-geo --knobs cones,steps -o room
)";

using Change = std::function<void(Mix&)>;
struct KnobValue {
    std::string value;
    Change change;
    bool robust = false;
};
struct Knob {
    std::string name, base;
    std::vector<KnobValue> values;
};

double total_weight(const Mix& mix) {
    double total = 0;
    for (const MixStrategy& s : mix.strategies) total += s.weight;
    return total;
}

bool changes_technique(const MixStrategy& s) {
    return s.info->name == "technique-change" || s.info->name == "chart-swap" || s.info->name == "chart-gibbs";
}

// The share of the mutations that the strategies have which `is` says.
template <class Is>
double share_of(const Mix& mix, const Is& is) {
    double own = 0;
    for (const MixStrategy& s : mix.strategies) own += is(s) ? s.weight : 0;
    return own / total_weight(mix);
}
template <class Is>
Change set_share(double share, const Is& is) {
    return [=](Mix& mix) {
        const double now = share_of(mix, is), factor = share / (1 - share) * (1 - now) / now;
        for (MixStrategy& s : mix.strategies)
            if (is(s)) s.weight *= factor;
    };
}

Knob large_step(const Mix& mix) {
    const auto is = [](const MixStrategy& s) { return s.info->name == "large-step"; };
    Knob knob{"large-step", fmt::format("{:.2g}", share_of(mix, is)), {}};
    if (share_of(mix, is) > 0 && share_of(mix, is) < 1)
        for (const double share : {0.02, 0.05, 0.1, 0.2, 0.4})
            knob.values.push_back({fmt::format("{:.2g}", share), set_share(share, is), false});
    return knob;
}

Knob swap_interval(const Mix& mix) {
    const double share = share_of(mix, changes_technique);
    Knob knob{"swap-interval", share > 0 ? fmt::format("{:.2g}", 1 / share) : "never", {}};
    if (share > 0 && share < 1)
        for (const double interval : {4.0, 16.0, 64.0})
            knob.values.push_back({fmt::format("{:.2g}", interval), set_share(1 / interval, changes_technique), false});
    return knob;
}

Knob steps(const Mix& mix) {
    Knob knob{"steps", "1", {}};
    for (const double factor : {0.25, 0.5, 2.0, 4.0})
        knob.values.push_back({fmt::format("{:g}", factor),
                               [factor](Mix& m) {
                                   for (MixStrategy& s : m.strategies) scale_steps(s, factor);
                               },
                               false});
    Mix other = mix;
    knob.values.front().change(other);
    if (other == mix) knob.values.clear();
    return knob;
}

// Keys of all strategies that have them.
Change set_everywhere(std::vector<std::pair<std::string, Value>> values) {
    return [values](Mix& mix) {
        for (MixStrategy& s : mix.strategies)
            for (const auto& [key, value] : values)
                if (s.parameters.contains(key)) s.parameters[key] = value;
    };
}

Knob cones(const Mix& mix) {
    Knob knob{"cones", "", {}};
    for (const MixStrategy& s : mix.strategies)
        if (s.weight > 0 && s.parameters.contains("estimator"))
            knob.base = is_choice(s.parameters, "estimator", "bvh-cut")
                            ? fmt::format("bvh-cut {}", std::get<std::int64_t>(s.parameters.at("boxes")))
                            : std::get<std::string>(s.parameters.at("estimator"));
    if (knob.base.empty()) return knob;
    for (const std::int64_t boxes : {5, 10, 20, 40})
        knob.values.push_back({fmt::format("bvh-cut {}", boxes),
                               set_everywhere({{"estimator", Value("bvh-cut")}, {"boxes", Value(boxes)}}), false});
    for (const char* estimator : {"fast", "exact"})
        knob.values.push_back({estimator, set_everywhere({{"estimator", Value(estimator)}}), false});
    return knob;
}

// A key of the mix file, with values as --set has them.
Knob key(const Mix& mix, const char* name, const std::string& key, const std::vector<std::string>& values) {
    Knob knob{name, "", {}};
    for (const MixField& field : mix_fields())
        if (field.key() == key)
            knob.base = std::visit([](const auto& v) { return fmt::format("{}", v); }, field.get(mix));
    for (const std::string& value : values)
        knob.values.push_back({value, [=](Mix& m) { set_value(m, key, value); }, false});
    return knob;
}

// `mix` is resolved.
std::vector<Knob> all_knobs(const Mix& mix) {
    const int longest = mix.lengths.max;
    std::vector<std::string> lengths;
    for (const int length : {longest / 3, 2 * longest / 3})
        if (length > mix.lengths.min) lengths.push_back(std::to_string(length));
    return {large_step(mix),
            swap_interval(mix),
            steps(mix),
            cones(mix),
            key(mix, "rectification", "rectification", {"off", "exclude", "walk-on", "retry"}),
            key(mix, "target", "target", {"luminance", "max-channel"}),
            key(mix, "chains", "chains.count", {"64", "256", "1024", "4096"}),
            key(mix, "bootstrap", "bootstrap.samples", {"16384", "65536", "262144", "1048576"}),
            key(mix, "starts", "bootstrap.most-starts", {"1", "0.1", "0.01"}),
            key(mix, "max-length", "lengths.max", lengths),
            {"robust", "off", {{"on", [](Mix&) {}, true}}}};
}

struct TradeoffOptions {
    ComparisonOptions comparison;
    std::vector<std::string> knobs;  // empty: all
};

bool asked(const TradeoffOptions& options, const std::string& knob) {
    return options.knobs.empty() || std::find(options.knobs.begin(), options.knobs.end(), knob) != options.knobs.end();
}

std::vector<ComparedEntry> make_entries(const TradeoffOptions& options, const LoadedScene& loaded, const Scene* robust,
                                        ComparisonPlan& plan) {
    RenderSettings settings;
    settings.mix = options.comparison.mix.apply_found(builtin_mix("fused"));
    settings.seconds = 1;
    const Mix base = resolve(*loaded.scene, settings).mix;
    std::vector<std::string> names;
    std::vector<ComparedEntry> entries(1);
    entries[0].name = base.name;
    entries[0].mix = base;
    for (const Knob& knob : all_knobs(base)) {
        names.push_back(knob.name);
        if (!asked(options, knob.name)) continue;
        plan.knobs[knob.name] = knob.base;
        for (const KnobValue& v : knob.values) {
            ComparedEntry entry;
            entry.mix = base;
            v.change(entry.mix);
            settle_fields(entry.mix);
            if (v.value == knob.base || contradiction(entry.mix)) continue;
            entry.name = knob.name + "=" + v.value;
            entry.knob = {knob.name, v.value};
            if (v.robust) entry.scene = robust;
            entries.push_back(std::move(entry));
        }
    }
    for (const std::string& name : options.knobs)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError({}, fmt::format("--knobs: unknown knob '{}'; {}", name, valid_names(name, names)));
    if (entries.size() == 1) throw InputError({}, "the mix '" + base.name + "' has none of these knobs");
    return entries;
}

int run(const TradeoffOptions& options) {
    LoadedScene robust;
    if (asked(options, "robust")) {
        ReaderOptions reader = options.comparison.scene.reader;
        reader.robust = true;
        robust = read_scene(options.comparison.scene.filename, reader);
    }
    return run_comparison_command(options.comparison, "tradeoff", [&](const LoadedScene& loaded, ComparisonPlan& plan) {
        return make_entries(options, loaded, robust.scene.get(), plan);
    });
}

}  // namespace

void add_tradeoff_command(CLI::App& keyhole, Runner& runner) {
    const auto options = std::make_shared<TradeoffOptions>();
    CLI::App* command = keyhole.add_subcommand("tradeoff", "Measure what each knob does to speed and accuracy");
    add_mix_option(*command, options->comparison.mix, "Whose knobs are turned", "fused");
    const auto knobs = [options](const std::string& text) {
        for (const std::string& name : split_list(text)) options->knobs.push_back(name);
    };
    add_parsed(*command, "--knobs", "NAME,...", knobs, "Only these knobs")->take_all();
    add_comparison_options(*command, options->comparison);
    command->footer(std::string(examples) + comparison_footer);
    command->callback([options, &runner] { runner = [options] { return run(*options); }; });
}

}  // namespace keyhole
