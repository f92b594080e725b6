// All that can be set in one side of a playground: its settings, and the controls of its materials.
#pragma once
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/play/model/play_scene.h"
#include "dreampm/play/model/play_state.h"

namespace dreampm::play {

/// The controls of a scene, and of the materials that its simulation has now. Materials that
/// `looks` lacks get the look of the scene there.
std::vector<ControlInfo> list_controls(const PlayScene& scene, const Simulation& simulation, Looks& looks);
/// The value of a control, as it is now.
double control_value(const ControlInfo& control, const PlayState& state, const Simulation& simulation);
/// The values of all controls, as they were asked for: what is under way is at its end.
std::vector<double> asked_values(const std::vector<ControlInfo>& controls, const PlayState& state,
                                 const Simulation& simulation);

}  // namespace dreampm::play
