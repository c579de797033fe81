// What the states of a mix are made by.
#pragma once

#include <memory>

#include "strategies/mix.h"

namespace keyhole {

// `mix` is resolved. Before any fit.
TechniqueDistribution make_techniques(const Mix& mix);

// For one thread; `layout` is of the scene and the mix's longest paths, and must outlive it.
std::unique_ptr<Evaluator> make_evaluator(const Scene& scene, const CoordinateLayout& layout, const Mix& mix);

// Gives back the room that a state of another mix has and this one's states have not.
void fit_state(PssState& state, const Mix& mix);

// Of one state, without the state itself.
std::size_t bytes_per_state(const CoordinateLayout& layout, const Mix& mix);

}  // namespace keyhole
