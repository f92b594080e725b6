#include "dreampm/play/model/compare.h"

#include "dreampm/model/scene.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {
namespace {

/// That kind of matter takes the place of the material that it is compared with.
void replace_material(PlayModel& side) {
  const auto& [main, replaced, kind] = side.compared;
  if (!kind) return;
  if (const auto liquid = other_liquid(side.simulation->scene().model(), *kind)) {
    side.simulation->set_parameter(replaced, "density", liquid->density);
    side.simulation->set_parameter(replaced, "viscosity", liquid->viscosity);
    side.looks.insert_or_assign(replaced, look_of(liquid->look));
    return side.list_controls();
  }
  if (const std::string name = side.ensure_matter(*kind); name != replaced) side.simulation->convert(replaced, name);
}

}  // namespace

std::string main_material(const Simulation& simulation) {
  std::string name;
  std::size_t most = 0;
  const model::Scene& scene = simulation.scene().model();
  if (!scene.emitters.empty()) name = scene.emitters.front().material;
  for (const model::Material& m : scene.materials) {
    const std::size_t count = simulation.particle_count(m.name);
    if (name.empty() || count > most) name = m.name, most = count;
  }
  return name;
}

void choose_matter(const Simulation& simulation, const std::vector<std::string>& refusals, Settings& settings) {
  const std::string name = main_material(simulation);
  const model::Scene& scene = simulation.scene().model();
  for (const model::Material& m : scene.materials) {
    if (m.name != name) continue;
    const auto kind = kind_of(m.name, m.type, m.values.has("viscosity") ? m.values["viscosity"] : 0);
    if (!kind) return;
    settings.matter = *kind;
    // The other kind, where the solver can do with it; else the same.
    const std::size_t other = compared_with(*kind);
    const bool is_there = refusals[other].empty() || other_liquid(scene, other);
    settings.compare_with = is_there ? other + 1 : 0;
  }
}

void begin_second_side(PlayModel& second, const PlayModel& first, std::optional<std::size_t> kind) {
  static_cast<PlayState&>(second) = first;
  second.films = first.films;
  second.compared.replaced = first.compared.main, second.compared.replacement = kind;
  if (kind) second.compared.main = matters()[*kind].name;
  // A simulation of the same scene takes snapshots of the other.
  const auto take_over = [&](const Snapshot& snapshot) {
    second.simulation->restore(snapshot);
    second.list_controls();
    replace_material(second);
  };
  take_over(first.loaded->start);
  second.loaded = std::make_shared<LoadedScene>(LoadedScene{first.play_scene(), second.simulation->snapshot()});
  take_over(first.simulation->snapshot());
  second.history.forget();
  second.end_tools();
}

}  // namespace dreampm::play
