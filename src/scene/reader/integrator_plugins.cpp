// Integrators: keyhole has its own, so only the length of paths is read.
#include "scene/reader/plugins.h"

namespace keyhole {
namespace {

const Plugins<int>& integrators() {
    static const Plugins<int> all = [] {
        Plugins<int> list;
        for (const char* type :
             {"path",     "bdpt", "direct",       "volpath", "volpath_simple", "volpathmis", "ptracer", "pssmlt",
              "mlt",      "erpt", "photonmapper", "ppm",     "sppm",           "vpl",        "ao",      "adaptive",
              "irrcache", "aov",  "moment",       "prb"})
            list.push_back({type, 0});
        return list;
    }();
    return all;
}

const std::vector<std::string> without_effect = {
    // of path tracers
    "rr_depth", "strict_normals", "hide_emitters", "emitter_samples", "bsdf_samples", "shading_samples",
    "hide_environment", "samples_per_pass", "block_size", "timeout",
    // of bdpt and ptracer
    "light_image", "sample_direct", "brute_force",
    // of pssmlt, mlt and erpt
    "bidirectional", "luminance_samples", "p_large", "two_stage", "direct_samples", "lens_perturbation",
    "multi_chain_perturbation", "caustic_perturbation", "manifold_perturbation", "bidirectional_mutation", "lambda",
    "num_chains", "max_chains", "chain_length", "work_units", "mutation_ratio", "technique",
    // of photon maps
    "global_photons", "caustic_photons", "volume_photons", "photon_count", "initial_radius", "alpha", "granularity",
    "max_passes", "lookup_size", "global_lookup_radius", "caustic_lookup_radius", "gather_locally", "auto_cancel",
    // of the rest
    "clamping", "shadow_map_resolution", "ray_length", "max_error", "p_value", "max_sample_factor", "aovs", "gradients",
    "clamp_neighbor", "clamp_screen", "overture", "quality", "quality_adjustment", "indirect_only", "debug"};

}  // namespace

void set_integrator(const Element& element, Context& context) {
    find_plugin(integrators(), element);
    Properties p(element, context.document, context.notes);
    const int depth = p.integer("max_depth", -1, 1 << 20, 0);
    if (p.has("max_depth") && depth == 0) p.fail(*p.find("max_depth"), "is 0; it must be positive, or -1 for any");
    if (depth != 0) context.builder.set_max_path_length(depth);
    p.ignore(without_effect);
    for (const auto* nested : p.objects("integrator")) set_integrator(*nested->target, context);
    p.finish();
}

}  // namespace keyhole
