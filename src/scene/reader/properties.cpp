#include "scene/reader/properties.h"

#include <algorithm>

#include "scene/reader/names.h"
#include "scene/reader/transforms.h"
#include "scene/reader/values.h"

namespace keyhole {
namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "<" : " or <") + words[i] + ">";
    return text;
}

std::string range_text(Range range) {
    if (range.high < Range::largest)
        return "between " + number_text(range.low) + " and " + number_text(range.high) +
               (range.open ? " (both excluded)" : "");
    if (range.low == 0) return "not negative and at most " + number_text(range.high);
    return "between " + number_text(range.low) + " and " + number_text(range.high);
}

bool inside(double x, Range range) {
    return range.open ? x > range.low && x < range.high : x >= range.low && x <= range.high;
}

}  // namespace

Properties::Properties(const Element& plugin, const Document& document, Notes& notes) : plugin_(plugin), notes_(notes) {
    for (const Element& element : plugin.children) {
        Child child{&element, &element, {}};
        if (const std::string* name = element.attribute("name")) child.name = canonical_parameter(*name);
        if (!child.name.empty()) check_first(child);
        if (element.tag == "ref") {
            child.target = &resolve(element, document);
            notes_.referenced.insert(child.target);
        }
        children_.push_back(std::move(child));
    }
}

void Properties::check_first(const Child& child) const {
    for (const Child& other : children_)
        if (other.name == child.name) fail(child, "is given twice; first at " + place_text(other.given->where));
}

std::string Properties::title() const {
    const std::string* type = plugin_.attribute("type");
    return type ? plugin_.tag + " '" + *type + "'" : "<" + plugin_.tag + ">";
}

std::string Properties::of(const std::string& name) const { return "parameter '" + name + "' of " + title(); }

void Properties::fail(const Child& child, const std::string& message) const {
    throw InputError(child.given->where, of(child.name) + " " + message);
}

bool Properties::has(const std::string& name) const {
    return std::any_of(children_.begin(), children_.end(), [&](const Child& c) { return c.name == name; });
}

const Properties::Child* Properties::find(const std::string& name) {
    if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) asked_.push_back(name);
    for (Child& child : children_) {
        if (child.name != name) continue;
        child.read = true;
        return &child;
    }
    return nullptr;
}

const Properties::Child& Properties::require(const std::string& name) {
    if (const Child* child = find(name)) return *child;
    throw InputError(plugin_.where, title() + " needs the parameter '" + name + "'");
}

const std::string& Properties::value(const Child& child, const std::vector<std::string>& tags) {
    if (std::find(tags.begin(), tags.end(), child.target->tag) == tags.end())
        fail(child, "is a <" + child.target->tag + ">; it must be " + joined(tags));
    return child.target->required_attribute("value");
}

std::optional<double> Properties::find_number(const std::string& name, Range range) {
    const Child* child = find(name);
    if (!child) return std::nullopt;
    const double x = parse_number(value(*child, {"float", "integer"}), child->given->where, of(name));
    if (!inside(x, range)) fail(*child, "is " + number_text(x) + "; it must be " + range_text(range));
    return x;
}

double Properties::number(const std::string& name, Range range) {
    require(name);
    return *find_number(name, range);
}

double Properties::number(const std::string& name, Range range, double fallback) {
    return find_number(name, range).value_or(fallback);
}

int Properties::integer(const std::string& name, int low, int high, int fallback) {
    const Child* child = find(name);
    if (!child) return fallback;
    const int x = parse_integer(value(*child, {"integer"}), child->given->where, of(name));
    if (x < low || x > high)
        fail(*child, "is " + std::to_string(x) + "; it must be between " + std::to_string(low) + " and " +
                         std::to_string(high));
    return x;
}

bool Properties::boolean(const std::string& name, bool fallback) {
    const Child* child = find(name);
    return child ? parse_boolean(value(*child, {"boolean"}), child->given->where, of(name)) : fallback;
}

std::optional<std::string> Properties::find_string(const std::string& name) {
    const Child* child = find(name);
    if (!child) return std::nullopt;
    return value(*child, {"string"});
}

std::string Properties::string(const std::string& name) {
    require(name);
    return *find_string(name);
}

std::string Properties::choice(const std::string& name, const std::vector<std::string>& valid,
                               const std::string& fallback) {
    const auto found = find_string(name);
    if (found && std::find(valid.begin(), valid.end(), *found) == valid.end())
        fail(*find(name), "is '" + *found + "'; " + valid_names(*found, valid));
    return found.value_or(fallback);
}

std::optional<Vec3> Properties::find_vector(const std::string& name, const std::string& tag) {
    const Child* child = find(name);
    if (!child) return std::nullopt;
    if (child->target->tag != "point" && child->target->tag != "vector")
        fail(*child, "is a <" + child->target->tag + ">; it must be <" + tag + ">");
    const Vec3 v = parse_xyz(*child->target);
    if (!(v.cwiseAbs().maxCoeff() <= Range::largest))
        fail(*child, "has a coordinate larger than " + number_text(Range::largest));
    return v;
}

Affine Properties::transform(const std::string& name) {
    const Child* child = find(name);
    if (!child) return Affine::Identity();
    if (child->target->tag != "transform") fail(*child, "is a <" + child->target->tag + ">; it must be <transform>");
    return parse_transform(*child->target);
}

Eigen::Matrix3d Properties::uv_transform(const std::string& name) {
    const Child* child = find(name);
    if (!child) return Eigen::Matrix3d::Identity();
    if (child->target->tag != "transform") fail(*child, "is a <" + child->target->tag + ">; it must be <transform>");
    return parse_uv_transform(*child->target);
}

std::vector<const Properties::Child*> Properties::objects(const std::string& tag) {
    std::vector<const Child*> found;
    for (Child& child : children_) {
        if (child.target->tag != tag) continue;
        child.read = true;
        found.push_back(&child);
    }
    return found;
}

const Properties::Child* Properties::object(const std::string& tag) {
    const auto found = objects(tag);
    if (found.size() > 1)
        throw InputError(found[1]->given->where,
                         title() + " has a second " + tag + "; first at " + place_text(found[0]->given->where));
    return found.empty() ? nullptr : found[0];
}

const Properties::Child& Properties::require_object(const std::string& tag) {
    if (const Child* child = object(tag)) return *child;
    throw InputError(plugin_.where, title() + " needs a nested " + tag);
}

void Properties::ignore(const std::vector<std::string>& names) {
    for (const auto& name : names)
        if (const Child* child = find(name))
            notes_.unused.push_back(of(name) + " has no effect (" + place_text(child->given->where) + ")");
}

void Properties::finish() {
    for (const Child& child : children_) {
        if (child.read) continue;
        const std::string message =
            child.name.empty()
                ? "unexpected <" + child.given->tag + "> without a name in " + title() + "; " + valid_names("", asked_)
                : "unknown " + of(*child.given->attribute("name")) + "; " + valid_names(child.name, asked_);
        if (!notes_.lenient) throw InputError(child.given->where, message);
        notes_.warnings.push_back(place_text(child.given->where) + ": " + message);
    }
}

}  // namespace keyhole
