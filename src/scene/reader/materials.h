// Named materials of scene files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/bsdfs.h"

namespace keyhole {

// Index of refraction and absorption of a metal ("Au", ...), relative to vacuum; "none" is a perfect mirror.
std::optional<ConductorIor> conductor_by_name(const std::string& name);
std::vector<std::string> conductor_names();

// Index of refraction of a dielectric ("bk7", "water", ...).
std::optional<double> dielectric_by_name(const std::string& name);
std::vector<std::string> dielectric_names();

}  // namespace keyhole
