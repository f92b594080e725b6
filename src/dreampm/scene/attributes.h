// Which attributes of particles a scene's runs write.
#pragma once
#include <string>
#include <vector>

#include "dreampm/model/scene.h"

namespace dreampm::scene {

/// Those that `output` names, and behind them what surfaces and pictures of the scene need of them:
/// j, age and source where surface.attributes names them, source where an emitter has a color.
std::vector<std::string> kept_attributes(const model::Scene& scene);

}  // namespace dreampm::scene
