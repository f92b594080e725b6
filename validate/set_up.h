// A scene's contents in a line.
#pragma once
#include <string>

#include "dreampm/model/scene.h"
#include "dreampm/state/world.h"

namespace dreampm::validate {

/// Materials with their sound, bodies with their pattern of particles, rigid bodies with their
/// density, cells, walls and steps. As the scene has them, so that the page of results cannot say
/// anything else than what was run.
/// `start`: assembled from it.
std::string set_up_of(const model::Scene& scene, const World<double>& start);

}  // namespace dreampm::validate
