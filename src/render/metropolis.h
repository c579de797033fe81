// Renders with Metropolis light transport: bootstrap, many chains in parallel, film.
#pragma once

#include "render/render.h"

namespace keyhole {

// `settings` are resolved.
RenderResult render_metropolis(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks);

}  // namespace keyhole
