// The variables of a scene file: <default>, -D and $name.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"

namespace keyhole {

class Variables {
  public:
    // `defines` (-D) take precedence over every <default>.
    explicit Variables(std::map<std::string, std::string> defines) : values_(defines), defines_(std::move(defines)) {}

    // A <default>. The first of a name counts, so that a scene can set those of a file that it includes; a second one
    // in the same file is an InputError.
    void set_default(const std::string& name, const std::string& value, const SourceLocation& where);

    // Replaces each $name (the longest run of letters, digits and _). Throws InputError for an undefined name.
    std::string substitute(const std::string& text, const SourceLocation& where);

    // Throws InputError at `scene` if a -D names neither a <default> nor a used variable.
    void check_defines(const SourceLocation& scene) const;

    // Defaults that nothing uses, as "default 'x' (file:line:column)".
    std::vector<std::string> unused() const;

  private:
    std::map<std::string, std::string> values_, defines_;
    std::map<std::string, SourceLocation> defaults_;
    std::set<std::string> used_;
};

}  // namespace keyhole
