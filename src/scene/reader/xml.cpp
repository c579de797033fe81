#include "scene/reader/xml.h"

#include <algorithm>
#include <pugixml.hpp>

#include "scene/reader/files.h"

namespace keyhole {
namespace {

constexpr int max_depth = 64;

// Turns byte offsets into lines and columns.
class Positions {
  public:
    Positions(std::string filename, const std::string& text) : filename_(std::move(filename)), text_(text) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts_.push_back(i + 1);
    }

    SourceLocation at(std::ptrdiff_t offset) const {
        const std::size_t i = std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
        const auto line = std::upper_bound(starts_.begin(), starts_.end(), i) - 1;
        int column = 1;
        for (std::size_t k = *line; k < i; ++k) column += (static_cast<unsigned char>(text_[k]) & 0xC0) != 0x80;
        return {filename_, static_cast<int>(line - starts_.begin()) + 1, column};
    }

  private:
    std::string filename_;
    const std::string& text_;
    std::vector<std::size_t> starts_{0};
};

Element convert(const pugi::xml_node& node, const Positions& positions, int depth) {
    Element element;
    element.tag = node.name();
    element.where = positions.at(node.offset_debug() - 1);
    if (depth > max_depth)
        throw InputError(element.where, "elements are nested deeper than " + std::to_string(max_depth));
    for (const auto& attribute : node.attributes()) {
        if (element.attribute(attribute.name()))
            throw InputError(element.where, "attribute '" + std::string(attribute.name()) + "' of <" + element.tag +
                                                "> is given twice");
        element.attributes.push_back({attribute.name(), attribute.value()});
    }
    for (const auto& child : node.children()) {
        if (child.type() != pugi::node_element)
            throw InputError(element.where,
                             "unexpected text '" + std::string(child.value()) + "' inside <" + element.tag + ">");
        element.children.push_back(convert(child, positions, depth + 1));
    }
    return element;
}

}  // namespace

const std::string* Element::attribute(const std::string& name) const {
    for (const auto& a : attributes)
        if (a.name == name) return &a.value;
    return nullptr;
}

const std::string& Element::required_attribute(const std::string& name) const {
    if (const std::string* value = attribute(name)) return *value;
    throw InputError(where, "<" + tag + "> needs the attribute '" + name + "'");
}

Element read_xml(const std::string& filename, const SourceLocation& from) {
    const std::string text = read_file(filename, from);
    const Positions positions(filename, text);
    if (const auto zero = text.find('\0'); zero != std::string::npos)
        throw InputError(positions.at(static_cast<std::ptrdiff_t>(zero)), "a zero byte: this is not an XML file");
    pugi::xml_document document;
    const auto result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
    if (!result)
        throw InputError(positions.at(result.offset), std::string("XML syntax error: ") + result.description());
    const pugi::xml_node root = document.document_element();
    if (!root) throw InputError(positions.at(0), "no <scene> element");
    for (const auto& node : document.children()) {
        if (node == root) continue;
        if (node.type() == pugi::node_element)
            throw InputError(positions.at(node.offset_debug() - 1),
                             "a second root element <" + std::string(node.name()) + ">; a file holds one <scene>");
        const std::string value = node.value();
        const auto blank = std::min(value.find_first_not_of(" \t\r\n"), value.size());
        throw InputError(positions.at(node.offset_debug() + static_cast<std::ptrdiff_t>(blank)),
                         "text outside of the <scene> element: '" + value.substr(blank) + "'");
    }
    Element scene = convert(root, positions, 0);
    if (scene.tag != "scene")
        throw InputError(scene.where, "the root element is <" + scene.tag + ">; it must be <scene>");
    return scene;
}

std::string place_text(const SourceLocation& where) {
    return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
}

}  // namespace keyhole
