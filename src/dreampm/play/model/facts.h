// What the materials of a simulation come to, in words.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// A line for each material: Young's modulus, density, speed of sound, Poisson's ratio and
/// viscosity of small strains.
std::vector<std::string> material_facts(const Simulation& simulation);
/// What would make the steps longer that are limited so (StepReport::limiter), and by which
/// material; empty: nothing is known.
std::string remedy(const Simulation& simulation, std::string_view limiter);
/// A warning where elastic matter is too soft for what presses on it, with those values of the
/// controls, and was not so with those before; else empty.
std::string softness_warning(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                             const std::vector<double>& before, const std::vector<double>& now);

}  // namespace dreampm::play
