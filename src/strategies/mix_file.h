// Mix files: a mix as TOML text. The format is described in docs/mix-files.md.
#pragma once

#include <string>
#include <vector>

#include "strategies/mix.h"

namespace keyhole {

// Throws InputError ("file:line:column: what was found; valid: ..."). `filename` is for its messages and, without its
// folder and extension, the name of a mix that does not give one.
Mix parse_mix(const std::string& text, const std::string& filename);

// Throws InputError also if the file cannot be read.
Mix read_mix_file(const std::string& filename);

// The canonical text of a mix: every key that has an effect, in the order of the documentation. parse_mix gives back an
// equal mix.
std::string write_mix(const Mix& mix);

// The mixes that come with Keyhole, from the files of mixes/, which are part of the program.
const std::vector<Mix>& builtin_mixes();

// A built-in mix by its name. Throws InputError (without a location) that lists the valid names.
const Mix& builtin_mix(const std::string& name);

// A file if the name looks like one (it ends in .toml or has a folder), else a built-in mix.
Mix find_mix(const std::string& name_or_file);

}  // namespace keyhole
