#include "dreampm/play/model/live_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "dreampm/model/scene.h"
#include "dreampm/physics/dt.h"
#include "dreampm/play/model/firmness.h"

namespace dreampm::play {
namespace {

/// Of the way to an end of a slider, to where it holds.
constexpr int halvings = 12;

constexpr std::array<std::string_view, 3> gravity_ids{"gravity.x", "gravity.y", "gravity.z"};

/// s of motion for what a step without stages costs, of such matter at rest.
double reach(const Stepping& s, const MaterialState& m) {
  const SignalSpeeds signals{0, m.sound_speed, 0, m.kinematic_viscosity, s.viscous_contacts};
  const double dt = stable_dt(s.cfl, s.cell, signals, 1e30, s.dt_max, s.sub_cycles).dt;
  return dt / (1 + (s.sub_cycles ? stage_cost * stages_of(dt, s.cell, m.kinematic_viscosity, s.viscous_contacts) : 0));
}

/// As if those were the values of all parameters of a material.
MaterialState state_with(const Simulation& simulation, const model::Material& material) {
  std::vector<ParameterValue> values;
  for (const auto& [key, value] : material.values) values.push_back({key, value});
  return simulation.material(material.name, values);
}

/// The parameter that a control sets; empty where it is none of that material.
std::string key_of(const ControlInfo& c, const model::Material& m) {
  const std::string start = "material." + m.name + ".";
  if (!c.id.starts_with(start)) return "";
  std::string key = c.id.substr(start.size());
  return m.values.has(key) ? key : "";
}

/// How firm the elastic materials are, as all is set and otherwise.
class Firmness {
 public:
  Firmness(const Simulation& simulation, const std::vector<ControlInfo>& controls, const std::vector<double>& values)
      : simulation_(simulation), presses_(presses_on(simulation)), materials_(simulation.scene().model().materials) {
    for (const model::Material& m : materials_) was_.push_back(m.values["density"]);
    for (std::size_t i = 0; i < controls.size(); ++i) {
      for (int a = 0; a < 3; ++a)
        if (controls[i].id == gravity_ids[std::size_t(a)]) gravity_[a] = values[i];
      for (model::Material& m : materials_)
        if (const std::string key = key_of(controls[i], m); !key.empty()) m.values.set(key, values[i]);
    }
    for (std::size_t m = 0; m < materials_.size(); ++m) now_.push_back(of(m, materials_[m], gravity_));
  }

  bool is_soft(std::size_t m) const { return now_[m] < least_firmness; }
  const std::string& name(std::size_t m) const { return materials_[m].name; }
  std::size_t count() const { return materials_.size(); }
  /// Whether it is firm, or no less so than now, with another value of a parameter.
  bool holds(std::size_t m, const std::string& key, double value) const {
    if (!presses_[m] || !is_of_firmness(key)) return true;
    model::Material with = materials_[m];
    with.values.set(key, value);
    return is_enough(m, of(m, with, gravity_));
  }
  /// Whether all are, with another component of gravity.
  bool hold(int axis, double value) const {
    Vec3d gravity = gravity_;
    gravity[axis] = value;
    for (std::size_t m = 0; m < materials_.size(); ++m)
      if (presses_[m] && !is_enough(m, of(m, materials_[m], gravity))) return false;
    return true;
  }

 private:
  bool is_enough(std::size_t m, double firmness) const {
    return firmness >= std::min(least_firmness, now_[m]) * (1 - 1e-9);
  }
  double of(std::size_t m, const model::Material& material, const Vec3d& gravity) const {
    if (!presses_[m]) return std::numeric_limits<double>::max();
    const double density = material.values["density"], c = state_with(simulation_, material).sound_speed;
    const double load = presses_[m]->load(length(gravity), density, was_[m]);
    return load > 0 ? density * c * c / load : std::numeric_limits<double>::max();
  }

  const Simulation& simulation_;
  std::vector<std::optional<Press>> presses_;
  std::vector<model::Material> materials_;  ///< as all is set
  Vec3d gravity_{};
  std::vector<double> was_;  ///< kg/m^3: density, as the particles have it
  std::vector<double> now_;
};

}  // namespace

std::vector<LiveRange> live_ranges(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                                   const std::vector<double>& values, double step_seconds, double asked) {
  std::vector<LiveRange> all;
  for (const ControlInfo& c : controls) all.push_back({c.min, c.max});
  const std::vector<model::Material>& materials = simulation.scene().model().materials;
  const Stepping steps = simulation.stepping();
  const bool is_fixed = steps.fixed_dt > 0;
  // What makes explicit steps short hardly bounds those of a projection.
  const bool is_large = steps.solver == "projection";
  std::vector<double> reaches;
  std::vector<bool> is_there;
  for (const model::Material& m : materials) {
    reaches.push_back(reach(steps, simulation.material(m.name)));
    is_there.push_back(simulation.particle_count(m.name) > 0);
  }
  const Firmness firmness(simulation, controls, values);
  const double live = least_pace * asked * step_seconds / (1 + stage_cost * steps.viscous_stages);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const ControlInfo& c = controls[i];
    if (!c.choices.empty()) continue;
    // From where it is set towards an end, as far as that holds.
    const auto bound = [&](double end, const auto& holds) {
      if (holds(end)) return end;
      double in = values[i], out = end;
      for (int n = 0; n < halvings; ++n) {
        const double middle = c.decades && in > 0 && out > 0 ? std::sqrt(in * out) : 0.5 * (in + out);
        (holds(middle) ? in : out) = middle;
      }
      return in;
    };
    const auto narrow = [&](const auto& is_live, const auto& is_firm) {
      const double min = bound(c.min, is_live), max = bound(c.max, is_live);
      const double soft_min = bound(c.min, is_firm), soft_max = bound(c.max, is_firm);
      all[i] = {std::max(min, soft_min), std::min(max, soft_max), soft_min > min, soft_max < max};
    };
    const auto any = [](double) { return true; };
    if (const auto axis = std::find(gravity_ids.begin(), gravity_ids.end(), c.id); axis != gravity_ids.end()) {
      const int a = static_cast<int>(axis - gravity_ids.begin());
      narrow(any, [&](double value) { return firmness.hold(a, value); });
    }
    for (std::size_t m = 0; m < materials.size(); ++m) {
      const std::string key = key_of(c, materials[m]);
      if (key.empty()) continue;
      double needed = std::min(live, reaches[m]);
      for (std::size_t other = 0; other < materials.size(); ++other)
        if (other != m && is_there[other]) needed = std::min(needed, reaches[other]);
      const auto is_live = [&](double value) {
        if (is_fixed || is_large) return true;
        model::Material with = materials[m];
        with.values.set(key, value);
        return reach(steps, state_with(simulation, with)) >= needed * (1 - 1e-9);
      };
      narrow(is_live, [&](double value) { return firmness.holds(m, key, value); });
    }
  }
  return all;
}

std::string too_soft(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                     const std::vector<double>& values) {
  const Firmness firmness(simulation, controls, values);
  for (std::size_t m = 0; m < firmness.count(); ++m)
    if (firmness.is_soft(m)) return firmness.name(m);
  return "";
}

}  // namespace dreampm::play
