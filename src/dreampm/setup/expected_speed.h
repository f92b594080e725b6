// The largest speed that a scene gives its matter, known before it runs.
#pragma once
#include <vector>

#include "dreampm/setup/assemble.h"
#include "dreampm/setup/filling.h"

namespace dreampm {

/// Energies add up: those of falling and of what fields give on the way. Matter has its own speed
/// besides. `world` has the scene's emitters and colliders.
ExpectedSpeed expected_speed(const model::Scene& scene, std::vector<Filling> fillings, const World<double>& world);

}  // namespace dreampm
