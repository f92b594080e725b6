// Emitters and sinks of a scene, as the solver takes them.
#pragma once
#include <string>
#include <vector>

#include "dreampm/level_set/level_set.h"
#include "dreampm/model/scene.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Adds them to a world whose box, colliders and walls were laid. What is wrong, an emitter outside
/// of the box or inside a collider, goes to `errors`, a line each; `file` names the scene.
void add_inflow(World<double>& world, const model::Scene& scene, const Meshes& meshes, const std::string& file,
                std::vector<std::string>& errors);

/// Particles that come in until a time [s] at most, if nothing stands in their way.
std::uint64_t most_inflow(const World<double>& world, double until);

}  // namespace dreampm
