// The rigid bodies of a scene, as the solver takes them.
#pragma once
#include <string>
#include <vector>

#include "dreampm/scene/description.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Makes those colliders of a world rigid bodies that the scene says are: mass, centre and inertia
/// of their shapes, and what they meet other bodies with. What is wrong, a body inside of another
/// or of a collider, goes to `errors`, a line each; `file` names the scene.
void add_rigid(World<double>& world, const SceneDescription& scene, const std::string& file,
               std::vector<std::string>& errors);

}  // namespace dreampm
