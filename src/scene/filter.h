// Reconstruction filters: separable, even, unit integral over the plane in units of pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace keyhole {

struct ReconstructionFilter {
    enum class Type { box, tent, gaussian } type = Type::box;
    double radius = 0.5;  // support is [-radius, radius]
    double stddev = 0.5;  // gaussian only; truncated at its radius, shifted to be zero there, and normalised
    double scale = 1;     // these two are set by the factories below
    double shift = 0;

    // Value in one dimension; normalised over its support.
    double operator()(double x) const {
        const double distance = std::abs(x);
        if (type == Type::tent) return std::max(0.0, scale * (1 - scale * distance));  // scale is 1 / radius
        if (distance > radius) return 0;
        return type == Type::box ? scale : scale * (bell(distance, stddev) - shift);
    }
    // The gaussian before it is shifted and normalised.
    static double bell(double x, double stddev) { return std::exp(-0.5 * (x / stddev) * (x / stddev)); }
    const char* name() const;
};

// Throw std::invalid_argument for a radius or standard deviation that is not positive.
ReconstructionFilter make_box_filter(double radius = 0.5);
ReconstructionFilter make_tent_filter(double radius = 1.0);
ReconstructionFilter make_gaussian_filter(double stddev = 0.5, double radius = 2.0);

struct FilmSettings {
    int width = 768, height = 576;
    int crop_x = 0, crop_y = 0, crop_width = 768, crop_height = 576;
    ReconstructionFilter filter;
};

}  // namespace keyhole
