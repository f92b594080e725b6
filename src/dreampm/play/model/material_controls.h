// The controls of a scene's materials: their parameters, which go to what is asked for by and by,
// and their colors.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/play_scene.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// How matter looks, by the name of its material.
using Looks = std::map<std::string, MatterLook>;
/// Values of parameters that were asked for and are not reached yet, by the id of the control.
using Targets = std::map<std::string, double>;

/// How matter looks whose scene says so.
MatterLook look_of(const model::Look& look);

/// What the id of a material's control names: "material.water.viscosity".
struct MaterialKey {
  std::string material, key;
};
/// Nothing for ids of other controls.
std::optional<MaterialKey> material_key(std::string_view id);
std::string material_control_id(std::string_view material, std::string_view key);

/// The controls of the materials that a simulation of that scene has now. Materials that `looks`
/// lacks get the look of the scene there.
std::vector<ControlInfo> material_controls(const PlayScene& scene, const Simulation& simulation, Looks& looks);

/// The member of a look that a control sets; null for other controls.
float* look_member(Looks& looks, std::string_view id);
/// The value of a control of a material, as it is now; its fallback where the material is gone.
double material_value(const ControlInfo& control, const Simulation& simulation, const Looks& looks);
/// A parameter, by the id of its control, at once.
void set_parameter(Simulation& simulation, std::string_view id, double value);

/// Where a control is a tick later that goes from `now` to `target`, no faster than matter can
/// take.
double next_value(const ControlInfo& control, double now, double target);
/// Moves the parameters a tick further to their targets. Returns the materials of those that are
/// there now, whose targets are erased.
std::vector<std::string> approach_targets(Simulation& simulation, const std::vector<ControlInfo>& controls,
                                          const Looks& looks, Targets& targets);

}  // namespace dreampm::play
