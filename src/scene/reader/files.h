// Files that a scene refers to.
#pragma once

#include <string>

#include "base/error.h"
#include "base/hash.h"

namespace keyhole {

// The whole file. Throws InputError at `from`, the place that names the file.
std::string read_file(const std::string& filename, const SourceLocation& from);

// Where the file `name`, written in the file `from.file` of the scene `scene_file`, lies: beside the file that names
// it, else beside the scene. Absolute paths are kept. Throws InputError at `from` if it is not there.
std::string find_file(const std::string& name, const SourceLocation& from, const std::string& scene_file);

// One name per file, whatever way it was reached.
std::string canonical_path(const std::string& filename);

}  // namespace keyhole
