// A scene file as one tree: includes spliced in, variables replaced, every element and attribute known to exist.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/reader/xml.h"

namespace keyhole {

struct Document {
    std::string filename;
    Element scene;
    std::map<std::string, const Element*> ids;  // of plugins, by `id` and <alias>
    std::vector<std::string> unused_defaults;

    Document() = default;
    Document(Document&&) = default;  // moving keeps the addresses of all elements but `scene` itself
};

// Throws InputError for all that read_xml, the schema and the variables refuse, for include cycles, ids given twice and
// a version that is not of Mitsuba 0.x to 3.x.
// What the file `portals` holds (empty: none), portals alone, is added to the scene.
Document load_document(const std::string& filename, const std::map<std::string, std::string>& defines,
                       const std::string& portals = {});

// The plugin that a <ref> names. Throws InputError if there is none.
const Element& resolve(const Element& ref, const Document& document);

// 64-bit hash of all elements and attributes (not of their places, comments or white space).
std::uint64_t content_hash(const Document& document);

}  // namespace keyhole
