#include "strategies/mix_file.h"

// Header-only, so that programs which use an installed Keyhole need no toml++.
#define TOML_HEADER_ONLY 1
#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "chain/mixture.h"

namespace keyhole {
namespace {

using Kind = toml::node_type;

const char* kind_name(Kind kind) {
    switch (kind) {
        case Kind::table:
            return "a table";
        case Kind::array:
            return "a list";
        case Kind::date:
        case Kind::time:
        case Kind::date_time:
            return "a date";
        default:
            return "a value";
    }
}

// Reads one file; knows where everything in it stands.
class Reader {
  public:
    explicit Reader(const std::string& filename) : filename_(filename) {}

    Mix read(const toml::table& root);

    SourceLocation place(const toml::source_position& p) const {
        return {filename_, static_cast<int>(p.line), static_cast<int>(p.column)};
    }

  private:
    [[noreturn]] void fail(const toml::source_position& p, const std::string& message) const {
        throw InputError(place(p), message);
    }
    // Runs `body` and gives its errors a place.
    template <class Body>
    auto at(const toml::source_position& p, const Body& body) const {
        try {
            return body();
        } catch (const InputError& e) {
            fail(p, e.what());
        }
    }

    void read_section(Mix& mix, const std::string& section, const toml::table& table);
    void read_strategies(Mix& mix, const toml::node& node);
    MixStrategy read_strategy(const Mix& mix, const toml::table& table);
    std::string read_label(const Mix& mix, const MixStrategy& strategy, const toml::table& table) const;
    Value read_value(const Parameter& parameter, const toml::node& node) const;

    std::string filename_;
    std::map<std::string, toml::source_position> places_;  // of keys and of strategies by label
};

Value Reader::read_value(const Parameter& parameter, const toml::node& node) const {
    return at(node.source().begin, [&] {
        if (const auto* v = node.as_boolean()) return checked(parameter, v->get());
        if (const auto* v = node.as_integer()) return checked(parameter, v->get());
        if (const auto* v = node.as_floating_point()) return checked(parameter, v->get());
        if (const auto* v = node.as_string()) return checked(parameter, v->get());
        throw InputError({}, fmt::format("'{}' cannot be {}; valid: {}", parameter.name, kind_name(node.type()),
                                         valid_values(parameter)));
    });
}

std::vector<std::string> section_names() {
    std::vector<std::string> names;
    for (const MixField& field : mix_fields())
        if (!field.section.empty() && std::find(names.begin(), names.end(), field.section) == names.end())
            names.push_back(field.section);
    return names;
}

std::vector<std::string> keys_of(const std::string& section) {
    std::vector<std::string> keys;
    for (const MixField& field : mix_fields())
        if (field.section == section) keys.push_back(field.parameter.name);
    if (!section.empty()) return keys;
    for (const std::string& name : section_names()) keys.push_back(name);
    keys.push_back("strategy");
    return keys;
}

void Reader::read_section(Mix& mix, const std::string& section, const toml::table& table) {
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        const auto field = std::find_if(mix_fields().begin(), mix_fields().end(), [&](const MixField& f) {
            return f.section == section && f.parameter.name == name;
        });
        if (field != mix_fields().end()) {
            places_[field->key()] = node.source().begin;
            field->set(mix, read_value(field->parameter, node));
            continue;
        }
        const auto sections = section_names();
        const bool is_section = section.empty() && std::find(sections.begin(), sections.end(), name) != sections.end();
        if (is_section && node.is_table()) {
            read_section(mix, name, *node.as_table());
        } else if (is_section) {
            fail(node.source().begin, fmt::format("'{0}' is {1}; valid: a table [{0}]", name, kind_name(node.type())));
        } else if (!(section.empty() && name == "strategy")) {
            fail(key.source().begin,
                 fmt::format("unknown key '{}'{}; {}", name, section.empty() ? "" : " of [" + section + "]",
                             valid_names(name, keys_of(section))));
        }
    }
}

// Given, or the strategy's name, with a number where that is taken.
std::string Reader::read_label(const Mix& mix, const MixStrategy& strategy, const toml::table& table) const {
    const auto taken = [&](const std::string& label) {
        return std::any_of(mix.strategies.begin(), mix.strategies.end(),
                           [&](const auto& s) { return s.label == label; });
    };
    const toml::node* node = table.get("label");
    if (!node) {
        std::string label = strategy.info->name;
        for (int i = 2; taken(label); ++i) label = fmt::format("{}-{}", strategy.info->name, i);
        return label;
    }
    const std::string label = std::get<std::string>(read_value(Parameter::text("label", ""), *node));
    const bool well_formed =
        !label.empty() && label.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
    if (!well_formed)
        fail(node->source().begin,
             fmt::format("'label' cannot be \"{}\"; valid: small letters, digits and hyphens", label));
    const auto keys = keys_of("");
    if (std::find(keys.begin(), keys.end(), label) != keys.end())
        fail(node->source().begin, fmt::format("'label' cannot be \"{}\", which is a key of the file", label));
    if (taken(label)) fail(node->source().begin, fmt::format("two strategies have the label '{}'", label));
    return label;
}

MixStrategy Reader::read_strategy(const Mix& mix, const toml::table& table) {
    const toml::source_position here = table.source().begin;
    const toml::node* type = table.get("type");
    if (!type) fail(here, "the strategy has no 'type'; `keyhole mixes strategies` lists them");
    MixStrategy strategy;
    const std::string name = std::get<std::string>(read_value(Parameter::text("type", ""), *type));
    strategy.info = at(type->source().begin, [&] { return &find_strategy(name); });
    strategy.label = read_label(mix, strategy, table);
    const toml::node* weight = table.get("weight");
    if (!weight) fail(here, fmt::format("'{}' has no 'weight'; valid: {}", name, valid_values(weight_parameter())));
    strategy.weight = std::get<double>(read_value(weight_parameter(), *weight));

    const std::vector<Parameter>& parameters = strategy.info->parameters;
    std::vector<std::string> keys = {"type", "weight", "label"};
    for (const Parameter& p : parameters) {
        keys.push_back(p.name);
        const toml::node* node = table.get(p.name);
        strategy.parameters[p.name] = node ? read_value(p, *node) : p.fallback;
    }
    for (const auto& [key, node] : table) {
        const std::string given(key.str());
        if (std::find(keys.begin(), keys.end(), given) == keys.end())
            fail(key.source().begin,
                 fmt::format("unknown key '{}' of '{}'; {}", given, name, valid_names(given, keys)));
        const auto p =
            std::find_if(parameters.begin(), parameters.end(), [&](const auto& q) { return q.name == given; });
        if (p != parameters.end() && !has_effect(*p, strategy.parameters))
            fail(key.source().begin,
                 fmt::format("'{}' has no effect here; it needs {} = \"{}\"", given, p->needs, p->needed_value));
    }
    if (const std::string wrong = settle(strategy); !wrong.empty()) fail(here, fmt::format("'{}': {}", name, wrong));
    places_[strategy.label] = here;
    return strategy;
}

void Reader::read_strategies(Mix& mix, const toml::node& node) {
    places_["strategy"] = node.source().begin;
    const toml::array* list = node.as_array();
    if (!list)
        fail(node.source().begin, fmt::format("'strategy' is {}; valid: tables [[strategy]]", kind_name(node.type())));
    for (const toml::node& entry : *list) {
        if (!entry.is_table())
            fail(entry.source().begin,
                 fmt::format("a strategy is {}; valid: a table [[strategy]]", kind_name(entry.type())));
        if (mix.strategies.size() == Mixture<PssState, Rng>::max_size)
            fail(entry.source().begin, fmt::format("a mix has at most {} strategies", mix.strategies.size()));
        mix.strategies.push_back(read_strategy(mix, *entry.as_table()));
    }
}

Mix Reader::read(const toml::table& root) {
    Mix mix;
    mix.name = std::filesystem::path(filename_).stem().string();
    read_section(mix, "", root);
    if (const toml::node* strategies = root.get("strategy")) read_strategies(mix, *strategies);
    if (const auto wrong = contradiction(mix)) {
        const auto known = places_.find(wrong->key);
        fail(known == places_.end() ? toml::source_position{1, 1} : known->second, wrong->message);
    }
    return mix;
}

}  // namespace

Mix parse_mix(const std::string& text, const std::string& filename) {
    Reader reader(filename);
    try {
        return reader.read(toml::parse(text));
    } catch (const toml::parse_error& e) {
        throw InputError(reader.place(e.source().begin), std::string(e.description()));
    }
}

Mix read_mix_file(const std::string& filename) {
    std::ifstream file(filename, std::ios::binary);
    std::ostringstream text;
    if (!file || std::filesystem::is_directory(filename) || !(text << file.rdbuf()))
        throw InputError({filename}, "the mix file cannot be read");
    return parse_mix(text.str(), filename);
}

std::string write_mix(const Mix& mix) {
    std::string text, section;
    for (const MixField& field : mix_fields()) {
        if (field.section != section) text += "\n[" + (section = field.section) + "]\n";
        text += field.parameter.name + " = " + to_toml(field.parameter, field.get(mix)) + "\n";
    }
    for (const MixStrategy& s : mix.strategies) {
        text += "\n[[strategy]]\ntype = \"" + s.info->name + "\"\n";
        if (s.label != s.info->name) text += "label = \"" + s.label + "\"\n";
        text += "weight = " + to_toml(weight_parameter(), s.weight) + "\n";
        for (const Parameter& p : s.info->parameters)
            if (has_effect(p, s.parameters)) text += p.name + " = " + to_toml(p, s.parameters.at(p.name)) + "\n";
    }
    return text;
}

}  // namespace keyhole
