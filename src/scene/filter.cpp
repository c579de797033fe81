#include "scene/filter.h"

#include <cmath>
#include <stdexcept>

#include "base/vec.h"

namespace keyhole {
namespace {

using Type = ReconstructionFilter::Type;

void require_positive(double value, const char* what) {
    if (!(value > 0) || !std::isfinite(value)) throw std::invalid_argument(std::string(what) + " must be positive");
}

}  // namespace

const char* ReconstructionFilter::name() const {
    switch (type) {
        case Type::box:
            return "box";
        case Type::tent:
            return "tent";
        case Type::gaussian:
            return "gaussian";
    }
    return "";
}

ReconstructionFilter make_box_filter(double radius) {
    require_positive(radius, "the filter's radius");
    return {.type = Type::box, .radius = radius, .scale = 1 / (2 * radius)};
}

ReconstructionFilter make_tent_filter(double radius) {
    require_positive(radius, "the filter's radius");
    return {.type = Type::tent, .radius = radius, .scale = 1 / radius};
}

ReconstructionFilter make_gaussian_filter(double stddev, double radius) {
    require_positive(stddev, "the filter's standard deviation");
    require_positive(radius, "the filter's radius");
    const double shift = ReconstructionFilter::bell(radius, stddev);
    const double integral =
        stddev * std::sqrt(2 * pi) * std::erf(radius / (stddev * std::sqrt(2.0))) - 2 * radius * shift;
    // The shifted bell loses its digits where the radius is a tiny part of the standard deviation.
    if (!(integral > 0) || radius < 1e-3 * stddev)
        throw std::invalid_argument("the filter's radius is too small for its standard deviation");
    return {.type = Type::gaussian, .radius = radius, .stddev = stddev, .scale = 1 / integral, .shift = shift};
}

}  // namespace keyhole
