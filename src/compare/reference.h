// The image that a comparison measures errors against, with what is known of its own noise.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "render/render.h"

namespace keyhole {

struct Reference {
    Image image;
    std::optional<Image> variance;  // of each value of the image
    std::string filename;
    // How it was made; empty and 0 if not known.
    std::string integrator;
    std::uint64_t samples_per_pixel = 0;
    double seconds = 0;
};

// An image of any origin. If it was made by make_reference(), with its variance. Throws InputError if it cannot be
// read.
Reference read_reference(const std::string& filename);

struct ReferencePlan {
    std::string filename;                      // .exr; the variance goes beside it, as NAME-variance.exr
    Integrator integrator = Integrator::bdpt;  // path or bdpt
    PathLengths lengths;                       // resolved
    double seconds = 600;                      // in all, over all calls
    std::uint64_t seed = 0;
    int threads = 0;
};

// The mean of independent images of equally many samples, and their variance. Written every half minute and at the end;
// a call for a file that is there goes on where it ended, if anything is left to do. Throws InputError if the file
// there is not a reference of this scene, integrator and these lengths.
Reference make_reference(const Scene& scene, const ReferencePlan& plan, const RenderCallbacks& callbacks);

}  // namespace keyhole
