#include "dreampm/play/model/controls.h"

#include <iterator>
#include <utility>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {
namespace {

/// Those of the settings that the scene has a use for.
std::vector<ControlInfo> settings_of(const PlayScene& scene) {
  std::vector<ControlInfo> all;
  const model::Scene& model = scene.scene.model();
  for (const SettingControl& c : setting_controls()) {
    if (c.info.panel == "Report" && !scene.report) continue;
    if (c.info.id == "cfl" && !is_projection(model)) continue;
    ControlInfo& own = all.emplace_back(c.info);
    if (own.id == "cfl") own.fallback = model.time.cfl;
    if (own.id == "time_step") own.max = scene.max_time_step;
    // Back to the gravity of the scene.
    if (own.id == "gravity.x") own.fallback = model.gravity.x;
    if (own.id == "gravity.y") own.fallback = model.gravity.y;
    if (own.id == "gravity.z") own.fallback = model.gravity.z;
  }
  return all;
}

}  // namespace

std::vector<ControlInfo> list_controls(const PlayScene& scene, const Simulation& simulation, Looks& looks) {
  std::vector<ControlInfo> all = settings_of(scene), own = material_controls(scene, simulation, looks);
  all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  return all;
}

double control_value(const ControlInfo& control, const PlayState& state, const Simulation& simulation) {
  for (const SettingControl& c : setting_controls())
    if (c.info.id == control.id) return c.value(state.settings);
  return material_value(control, simulation, state.looks);
}

std::vector<double> asked_values(const std::vector<ControlInfo>& controls, const PlayState& state,
                                 const Simulation& simulation) {
  std::vector<double> values;
  for (const ControlInfo& c : controls) {
    const auto target = state.targets.find(c.id);
    values.push_back(target == state.targets.end() ? control_value(c, state, simulation) : target->second);
  }
  return values;
}

}  // namespace dreampm::play
