// Renders with the reference estimators, path and bdpt.
#pragma once

#include "render/render.h"

namespace keyhole {

// `settings` are resolved.
RenderResult render_unbiased(const Scene& scene, const RenderSettings& settings, const RenderCallbacks& callbacks);

}  // namespace keyhole
