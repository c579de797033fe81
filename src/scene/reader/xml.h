// An XML file as a tree of elements that know where they stand.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace keyhole {

struct Attribute {
    std::string name, value;
};

struct Element {
    std::string tag;
    std::vector<Attribute> attributes;
    std::vector<Element> children;
    SourceLocation where;      // of the opening '<'; columns count characters, not bytes
    bool old_dialect = false;  // Mitsuba 0.x: its defaults differ in places

    // The attribute's value, or null.
    const std::string* attribute(const std::string& name) const;
    // The attribute's value; InputError if it is missing.
    const std::string& required_attribute(const std::string& name) const;
};

// Reads a file whose only root is <scene>. Throws InputError, located at `from` (the element that names the file) if it
// cannot be read, else in the file: syntax errors, text between elements, elements nested deeper than 64, an attribute
// given twice.
Element read_xml(const std::string& filename, const SourceLocation& from);

// "file:line:column".
std::string place_text(const SourceLocation& where);

}  // namespace keyhole
