// Names of a scene that are nearly those of a path.
#pragma once
#include <string>

#include "dreampm/model/scene.h"

namespace dreampm::scene {

/// Of a path such as materials.watr.viscosity: "no 'watr' in materials; did you mean 'water'?".
/// Empty where all names before its last lead somewhere in the scene.
std::string unknown_name(const model::Scene& scene, const std::string& path);

}  // namespace dreampm::scene
