// Notes on settings of a scene that have no effect, or another one than its author may expect.
#pragma once
#include <string>
#include <vector>

#include "dreampm/level_set/level_set.h"
#include "dreampm/model/scene.h"

namespace dreampm {

/// A line each.
std::vector<std::string> notes_on(const model::Scene& scene, const std::string& file, const Meshes& meshes);

}  // namespace dreampm
