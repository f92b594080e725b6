#include "dreampm/play/live_range.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dreampm/physics/dt.h"
#include "dreampm/physics/materials.h"
#include "dreampm/scene/description.h"
#include "dreampm/simulation/assemble.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm::play {
namespace {

/// Of the way to an end of a slider, to where it holds.
constexpr int halvings = 12;

/// What steps depend on besides the matter.
struct Steps {
  double cfl, dx, dt_max;
  int contacts, stages;
  bool sub_cycles, fixed;

  /// s of motion for what a step without stages costs, of such matter at rest.
  double reach(const MaterialFacts& f) const {
    const SignalSpeeds signals{0, f.sound_speed, 0, f.kinematic_viscosity, contacts};
    const double dt = stable_dt(cfl, dx, signals, 1e30, dt_max, sub_cycles).dt;
    return dt / (1 + (sub_cycles ? stage_cost * stages_of(dt, dx, f.kinematic_viscosity, contacts) : 0));
  }
};

MaterialFacts facts_with(const scene::Material& material, const std::string& key, double value,
                         const ExpectedSpeed& expected) {
  scene::Material with = material;
  with.values.set(key, value);
  ParticleSet<double> set;
  std::vector<std::string> notes;
  use_material(set, std::move(with), World<double>{}, expected, notes);  // cells change no fact
  return facts_of(*material.info, set.values);
}

}  // namespace

std::vector<LiveRange> live_ranges(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                                   const std::vector<double>& values, double step_seconds, double asked) {
  std::vector<LiveRange> all;
  for (const ControlInfo& c : controls) all.push_back({c.min, c.max});
  const std::vector<scene::Material>& materials = simulation.scene().description().materials;
  std::vector<double> reach;
  std::vector<bool> is_there;
  const Steps steps = simulation.impl().with_engine([&](auto& engine) {
    const auto& w = engine.world();
    const Steps s{
        w.settings.cfl,         w.dx, w.settings.dt_max, w.viscous_contacts(), w.viscous_stages, w.settings.sub_cycles,
        w.settings.fixed_dt > 0};
    for (std::size_t m = 0; m < materials.size(); ++m) {
      reach.push_back(s.reach(facts_of(*materials[m].info, w.sets[m].values)));
      is_there.push_back(w.sets[m].size() > 0);
    }
    return s;
  });
  if (steps.fixed) return all;
  const double live = least_pace * asked * step_seconds / (1 + stage_cost * steps.stages);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const ControlInfo& c = controls[i];
    const auto owner = std::find_if(materials.begin(), materials.end(), [&](const scene::Material& m) {
      return c.id.starts_with("material." + m.name + ".");
    });
    if (owner == materials.end() || !c.choices.empty()) continue;
    const std::string key = c.id.substr(std::string("material.").size() + owner->name.size() + 1);
    if (!owner->values.has(key)) continue;
    const auto m = static_cast<std::size_t>(owner - materials.begin());
    double needed = std::min(live, reach[m]);
    for (std::size_t other = 0; other < materials.size(); ++other)
      if (other != m && is_there[other]) needed = std::min(needed, reach[other]);
    const auto is_live = [&](double value) {
      const MaterialFacts f = facts_with(*owner, key, value, simulation.impl().state.expected);
      return steps.reach(f) >= needed * (1 - 1e-9);
    };
    const auto bound = [&](double end) {
      if (is_live(end)) return end;
      double in = values[i], out = end;
      for (int n = 0; n < halvings; ++n) {
        const double middle = c.decades && in > 0 && out > 0 ? std::sqrt(in * out) : 0.5 * (in + out);
        (is_live(middle) ? in : out) = middle;
      }
      return in;
    };
    all[i] = {bound(c.min), bound(c.max)};
  }
  return all;
}

}  // namespace dreampm::play
