#include "strategies/mix.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/error.h"

namespace keyhole {
namespace {

constexpr std::int64_t most_chains = 1 << 30, many = std::int64_t{1} << 50;
constexpr std::int64_t fewest_samples = 4;  // of a bootstrap: a quarter of them fits the techniques

// A key that is kept in a member of Mix: a text, a number, or an enumeration whose choices stand in its order.
template <class Member>
MixField field(std::string section, Parameter parameter, Member member) {
    using T = std::remove_reference_t<decltype(member(std::declval<Mix&>()))>;
    const auto names = parameter.choices;
    const auto get = [=](const Mix& mix) -> Value {
        if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, double>)
            return member(mix);
        else if (names.empty())
            return static_cast<std::int64_t>(member(mix));
        else
            return names.at(static_cast<std::size_t>(member(mix)));
    };
    const auto set = [=](Mix& mix, const Value& value) {
        if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, double>)
            member(mix) = std::get<T>(value);
        else if (names.empty())
            member(mix) = static_cast<T>(std::get<std::int64_t>(value));
        else
            member(mix) =
                static_cast<T>(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin());
    };
    return {std::move(section), std::move(parameter), get, set};
}

std::vector<MixField> make_fields() {
    using P = Parameter;
    const auto target = P::choice("target", {"luminance", "max-channel"},
                                  "what a path counts as: the luminance or the largest channel of its contribution");
    const auto rectification = P::choice(
        "rectification", {"off", "exclude", "walk-on", "retry"},
        "what follows a proposal without contribution: nothing; a new draw (biased); a step on; a smaller step");
    const auto walk_steps = P::integer("walk-steps", 4, 2, 1000, "steps of a walk on, the first one included")
                                .only_with("rectification", "walk-on");
    const auto retry_scale = P::number("retry-scale", 0.25, 0, 1, "size of the second step, in units of the first")
                                 .open()
                                 .only_with("rectification", "retry");
    const auto max_length =
        P::integer("max", 0, 1, PathLengths::longest, "longest path; \"scene\": what the scene file says, else 12");
    const auto chain_length =
        P::integer("length", 0, 1, many,
                   "mutations of each chain, where the command gives neither a time nor a number; else \"auto\"");
    constexpr auto any_seed = std::numeric_limits<std::int64_t>::max();
    return {
        field(
            "", P::text("name", "in statistics and comparisons; without it, the file's name"),
            [](auto& m) -> auto& { return m.name; }),
        field(
            "", P::text("description", "one line for people"), [](auto& m) -> auto& { return m.description; }),
        field(
            "", target, [](auto& m) -> auto& { return m.target; }),
        field(
            "", rectification, [](auto& m) -> auto& { return m.rectification.policy; }),
        field(
            "", walk_steps, [](auto& m) -> auto& { return m.rectification.walk_steps; }),
        field(
            "", retry_scale, [](auto& m) -> auto& { return m.rectification.retry_scale; }),
        field(
            "", P::integer("seed", 0, 0, any_seed, "another seed gives another independent image"),
            [](auto& m) -> auto& { return m.seed; }),
        field(
            "",
            P::choice(
                "tuning", {"off", "race"},
                "\"race\": before the first mutation that counts, sets of the strategies compete in the scene, and "
                "the winner's weights and sizes are adapted"),
            [](auto& m) -> auto& { return m.tuning; }),
        field(
            "lengths", P::integer("min", 1, 1, PathLengths::longest, "shortest path").in("edges"),
            [](auto& m) -> auto& { return m.lengths.min; }),
        field(
            "lengths", max_length.in("edges").or_word("scene"), [](auto& m) -> auto& { return m.lengths.max; }),
        field(
            "lengths",
            P::choice("per-chain", {"free", "fixed"}, "\"fixed\": each chain keeps the length it began with"),
            [](auto& m) -> auto& { return m.lengths.fixed; }),
        field(
            "techniques",
            P::choice("light-vertices", {"any", "at-most-one", "one", "none"},
                      "how many vertices techniques sample from the light; light that only others find is missing"),
            [](auto& m) -> auto& { return m.techniques.light_vertices; }),
        field(
            "techniques",
            P::choice("per-state", {"one", "all"},
                      "\"all\": a state is all paths that connecting one eye and one light subpath makes"),
            [](auto& m) -> auto& { return m.techniques.all_at_once; }),
        field(
            "techniques",
            P::choice("weights", {"target", "splat"},
                      "where the weights between techniques go: into the target, or only into the splats"),
            [](auto& m) -> auto& { return m.techniques.weighting; }),
        field(
            "chains", P::integer("count", 0, 1, most_chains, "number of chains").or_word("auto"),
            [](auto& m) -> auto& { return m.chain_count; }),
        field(
            "chains",
            P::integer("exchange-every", 0, 1, 1 << 30,
                       "mutations of each chain between exchanges of paths between chains in different charts")
                .or_word("never"),
            [](auto& m) -> auto& { return m.exchange_every; }),
        field(
            "chains", chain_length.or_word("auto"), [](auto& m) -> auto& { return m.chain_length; }),
        field(
            "bootstrap",
            P::integer("samples", 0, fewest_samples, many, "independent paths, from which the chains start")
                .or_word("auto"),
            [](auto& m) -> auto& { return m.bootstrap_samples; }),
        field(
            "bootstrap",
            P::number(
                "most-starts", 1, 1e-6, 1,
                "largest share of the chains that start from one path; below 1 less noise and a bias of the start"),
            [](auto& m) -> auto& { return m.most_starts; }),
    };
}

std::vector<std::string> all_keys(const Mix& mix) {
    std::vector<std::string> keys;
    for (const MixField& field : mix_fields()) keys.push_back(field.key());
    for (const MixStrategy& s : mix.strategies) {
        keys.push_back(s.label + ".weight");
        for (const Parameter& p : s.info->parameters) keys.push_back(s.label + "." + p.name);
    }
    return keys;
}

// The strategy that a key such as "small-step.sigma" is about; null if it is about none.
MixStrategy* strategy_of(Mix& mix, const std::string& key) {
    const std::string label = key.substr(0, key.find('.'));
    const auto found =
        std::find_if(mix.strategies.begin(), mix.strategies.end(), [&](const auto& s) { return s.label == label; });
    return found == mix.strategies.end() ? nullptr : &*found;
}

const Parameter* parameter_of(const MixStrategy& strategy, const std::string& key) {
    const std::string name = key.substr(key.find('.') + 1);
    for (const Parameter& p : strategy.info->parameters)
        if (p.name == name) return &p;
    return nullptr;
}

std::optional<Contradiction> techniques_contradiction(const Mix& mix) {
    const TechniqueChoice& choice = mix.techniques;
    if (choice.all_at_once && mix.lengths.fixed)
        return Contradiction{"techniques.per-state",
                             "a state of all techniques has paths of all lengths; it cannot keep one"};
    if (choice.all_at_once && choice.weighting == Weighting::splat)
        return Contradiction{"techniques.weights", "with all techniques in a state, the target must be weighted"};
    if (mix.exchange_every > 0 && (choice.all_at_once || choice.weighting == Weighting::splat))
        return Contradiction{"chains.exchange-every",
                             "chains exchange paths only where each state is one path with its technique's weight in "
                             "the target"};
    for (const MixStrategy& s : mix.strategies) {
        if (choice.all_at_once && !s.info->all_at_once && s.weight > 0)
            return Contradiction{"techniques.per-state",
                                 fmt::format("'{}' moves states of one technique; here each state holds all", s.label)};
        if (choice.weighting == Weighting::splat && s.info->needs.path && s.weight > 0)
            return Contradiction{"techniques.weights",
                                 fmt::format("'{}' moves between techniques by their weights in the target", s.label)};
    }
    return {};
}

std::optional<Contradiction> strategies_contradiction(const Mix& mix) {
    const auto used = [](const MixStrategy& s) { return s.weight > 0; };
    if (mix.strategies.empty())
        return Contradiction{"strategy", "a mix needs at least one strategy, as a table [[strategy]]"};
    if (std::none_of(mix.strategies.begin(), mix.strategies.end(), used))
        return Contradiction{"strategy", "all weights are zero; at least one must be above"};
    const auto ergodic = [&](const MixStrategy& s) { return used(s) && s.info->ergodic; };
    if (std::none_of(mix.strategies.begin(), mix.strategies.end(), ergodic)) {
        std::string names;
        for (const StrategyInfo& info : strategy_registry())
            if (info.ergodic) names += (names.empty() ? "" : ", ") + info.name;
        return Contradiction{"strategy",
                             "no strategy of positive weight reaches every path; one of these does: " + names};
    }
    for (auto a = mix.strategies.begin(); a != mix.strategies.end(); ++a)
        for (auto b = mix.strategies.begin(); b != a; ++b) {
            if (a->label == b->label)
                return Contradiction{a->label, "two strategies have the label '" + a->label + "'"};
            if (a->info == b->info && a->parameters == b->parameters)
                return Contradiction{a->label,
                                     fmt::format("'{}' and '{}' are the same strategy with the same parameters; "
                                                 "give one of them both weights",
                                                 b->label, a->label)};
        }
    return {};
}

}  // namespace

TechniqueSet TechniqueChoice::set() const {
    switch (light_vertices) {
        case LightVertices::any:
            return all_techniques;
        case LightVertices::at_most_one:
            return unidirectional_techniques;
        case LightVertices::one:
            return {1, 1};
        case LightVertices::none:
            return {0, 0};
    }
    return all_techniques;
}

const std::vector<MixField>& mix_fields() {
    static const std::vector<MixField> fields = make_fields();
    return fields;
}

bool has_effect(const MixField& field, const Mix& mix) {
    if (field.parameter.needs.empty()) return true;
    for (const MixField& other : mix_fields())
        if (other.key() == field.parameter.needs) return other.get(mix) == Value(field.parameter.needed_value);
    return false;
}

void settle_fields(Mix& mix) {
    for (const MixField& field : mix_fields())
        if (!has_effect(field, mix)) field.set(mix, field.parameter.fallback);
}

const Parameter& weight_parameter() {
    static const Parameter weight =
        Parameter::number("weight", 1, 0, 1e12, "how often it is chosen, relative to the others; 0: never");
    return weight;
}

void set_value(Mix& mix, const std::string& key, const std::string& text) {
    for (const MixField& field : mix_fields())
        if (field.key() == key) return field.set(mix, value_from_text(field.parameter, text));
    if (MixStrategy* strategy = strategy_of(mix, key)) {
        if (key == strategy->label + ".weight") {
            strategy->weight = std::get<double>(value_from_text(weight_parameter(), text));
            return;
        }
        if (const Parameter* p = parameter_of(*strategy, key)) {
            strategy->parameters[p->name] = value_from_text(*p, text);
            return;
        }
    }
    throw InputError({}, fmt::format("unknown key '{}'; {}", key, valid_names(key, all_keys(mix))));
}

std::string settle(MixStrategy& strategy) {
    for (const Parameter& p : strategy.info->parameters)
        if (!has_effect(p, strategy.parameters)) strategy.parameters[p.name] = p.fallback;
    return strategy.info->contradiction ? strategy.info->contradiction(strategy.parameters) : "";
}

bool scale_steps(MixStrategy& s, double factor) {
    const Values old = s.parameters;
    for (const Parameter& p : s.info->parameters)
        if (p.step_size && has_effect(p, s.parameters))
            s.parameters[p.name] = std::clamp(number(s.parameters, p.name.c_str()) * factor, p.min, p.max);
    return s.parameters != old && settle(s).empty();
}

std::optional<Contradiction> contradiction(const Mix& mix) {
    if (mix.lengths.max > 0 && mix.lengths.max < mix.lengths.min)
        return Contradiction{"lengths.max",
                             fmt::format("'max' = {} is below 'min' = {}", mix.lengths.max, mix.lengths.min)};
    if (const auto wrong = techniques_contradiction(mix)) return wrong;
    return strategies_contradiction(mix);
}

void apply_settings(Mix& mix, const std::vector<Setting>& settings) {
    for (const Setting& s : settings) {
        try {
            set_value(mix, s.key, s.text);
        } catch (const InputError& e) {
            throw InputError({}, s.origin + ": " + e.what());
        }
    }
    for (const Setting& s : settings) {
        const MixStrategy* strategy = strategy_of(mix, s.key);
        const Parameter* p = strategy ? parameter_of(*strategy, s.key) : nullptr;
        if (p && !has_effect(*p, strategy->parameters))
            throw InputError({}, fmt::format("{}: {} has no effect here; it needs {}.{}={}", s.origin, s.key,
                                             strategy->label, p->needs, p->needed_value));
    }
    for (const Setting& s : settings)
        for (const MixField& field : mix_fields())
            if (s.key == field.key() && !has_effect(field, mix))
                throw InputError({}, fmt::format("{}: {} has no effect here; it needs {}={}", s.origin, s.key,
                                                 field.parameter.needs, field.parameter.needed_value));
    settle_fields(mix);
    for (MixStrategy& strategy : mix.strategies)
        if (const std::string wrong = settle(strategy); !wrong.empty())
            throw InputError({}, strategy.label + ": " + wrong);
    if (const auto wrong = contradiction(mix)) throw InputError({}, wrong->message);
}

}  // namespace keyhole
