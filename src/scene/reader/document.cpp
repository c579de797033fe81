#include "scene/reader/document.h"

#include <algorithm>

#include "scene/reader/files.h"
#include "scene/reader/names.h"
#include "scene/reader/schema.h"
#include "scene/reader/variables.h"

namespace keyhole {
namespace {

constexpr std::size_t max_includes = 1000;

bool is_old_dialect(const Element& scene) {
    const std::string& version = scene.required_attribute("version");
    const std::string major = version.substr(0, version.find('.'));
    if (major != "0" && major != "2" && major != "3")
        throw InputError(scene.where, "version '" + version + "' is not known; valid names: 0.x, 2.x, 3.x");
    return major == "0";
}

class Expander {
  public:
    Expander(const std::string& scene_file, Variables& variables) : scene_file_(scene_file), variables_(variables) {}

    Element expand_file(const std::string& filename, const SourceLocation& from) {
        open_.push_back(canonical_path(filename));
        Element raw = read_xml(filename, from);
        check_element(raw, raw);
        old_dialect_.push_back(is_old_dialect(raw));
        Element scene = expand(raw);
        old_dialect_.pop_back();
        open_.pop_back();
        return scene;
    }

  private:
    Element expand(Element& raw) {
        Element element{raw.tag, {}, {}, raw.where, old_dialect_.back()};
        for (const auto& [name, value] : raw.attributes)
            element.attributes.push_back({name, variables_.substitute(value, raw.where)});
        for (Element& child : raw.children) expand_into(element, child);
        return element;
    }

    void expand_into(Element& parent, Element& raw) {
        raw.tag = canonical_tag(raw.tag);
        check_element(raw, parent);
        Element child = expand(raw);
        if (child.tag == "default") {
            variables_.set_default(*child.attribute("name"), *child.attribute("value"), child.where);
        } else if (child.tag == "include") {
            Element included = include(child);
            std::move(included.children.begin(), included.children.end(), std::back_inserter(parent.children));
        } else {
            parent.children.push_back(std::move(child));
        }
    }

    Element include(const Element& directive) {
        const std::string filename = find_file(*directive.attribute("filename"), directive.where, scene_file_);
        const std::string path = canonical_path(filename);
        if (std::find(open_.begin(), open_.end(), path) != open_.end())
            throw InputError(directive.where, "include cycle: '" + filename + "' is being read already");
        if (++includes_ > max_includes)
            throw InputError(directive.where, "more than " + std::to_string(max_includes) + " includes");
        return expand_file(filename, directive.where);
    }

    std::string scene_file_;
    Variables& variables_;
    std::vector<std::string> open_;
    std::vector<bool> old_dialect_;
    std::size_t includes_ = 0;
};

void add_id(Document& document, const std::string& id, const Element& element, const SourceLocation& where) {
    if (id.empty()) throw InputError(where, "the id is empty");
    const auto [first, inserted] = document.ids.emplace(id, &element);
    if (!inserted)
        throw InputError(where, "the id '" + id + "' is given twice; first at " + place_text(first->second->where));
}

void collect_ids(Document& document, const Element& parent) {
    for (const Element& child : parent.children) {
        const std::string* id = child.attribute("id");
        if (id && tag_kind(child, parent) == TagKind::plugin) add_id(document, *id, child, child.where);
        collect_ids(document, child);
    }
}

void add_to_hash(Hash& hash, const Element& element) {
    hash.add(element.tag);
    hash.add(element.attributes.size());
    for (const auto& [name, value] : element.attributes) {
        hash.add(name);
        hash.add(value);
    }
    hash.add(element.children.size());
    for (const Element& child : element.children) add_to_hash(hash, child);
}

}  // namespace

Document load_document(const std::string& filename, const std::map<std::string, std::string>& defines,
                       const std::string& portals) {
    Variables variables(defines);
    Document document;
    document.filename = filename;
    document.scene = Expander(filename, variables).expand_file(filename, {});
    if (!portals.empty()) {
        Element side = Expander(portals, variables).expand_file(portals, {});
        for (Element& child : side.children) {
            const std::string* type = child.attribute("type");
            if (child.tag != "shape" || !type || *type != "portal")
                throw InputError(child.where, "<" + child.tag + (type ? " type=\"" + *type + "\"" : "") +
                                                  ">: a file of portals holds <shape type=\"portal\"> alone");
            document.scene.children.push_back(std::move(child));
        }
    }
    variables.check_defines(document.scene.where);
    document.unused_defaults = variables.unused();
    collect_ids(document, document.scene);
    for (const Element& child : document.scene.children) {
        if (child.tag != "alias") continue;
        const Element& target = resolve(child, document);
        add_id(document, *child.attribute("as"), target, child.where);
    }
    return document;
}

const Element& resolve(const Element& ref, const Document& document) {
    const std::string& id = *ref.attribute("id");
    const auto found = document.ids.find(id);
    if (found != document.ids.end()) return *found->second;
    std::vector<std::string> names;
    for (const auto& [name, element] : document.ids) names.push_back(name);
    throw InputError(ref.where, "unresolved reference '" + id + "'; " + valid_names(id, names));
}

std::uint64_t content_hash(const Document& document) {
    Hash hash;
    add_to_hash(hash, document.scene);
    return hash.value();
}

}  // namespace keyhole
