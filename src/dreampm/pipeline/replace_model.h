// Another model in place of the one a scene was written for.
#pragma once
#include <string>

#include "dreampm/model/scene.h"

namespace dreampm {

/// Puts `model` (a mesh file or asset:NAME) in place of the mesh of the scene's only body with one,
/// and makes it as much smaller about its center as the walls ask for, which it reports. Throws
/// InputError if the scene has no such body or several, and for a mesh that cannot be read.
void replace_model(model::Scene& scene, const std::string& model);

}  // namespace dreampm
