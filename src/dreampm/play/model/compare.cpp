// A and B: the same scene twice, under the same tools, with different materials.
#include <algorithm>
#include <string>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {

std::string PlayModel::main_material() const {
  std::string name;
  std::size_t most = 0;
  const model::Scene& scene = simulation->scene().model();
  // Where all matter is still to come, that of the first emitter.
  if (!scene.emitters.empty()) name = scene.emitters.front().material;
  for (const model::Material& m : scene.materials) {
    const std::size_t count = simulation->particle_count(m.name);
    if (name.empty() || count > most) name = m.name, most = count;
  }
  return name;
}

void PlayModel::choose_matter() {
  const std::string name = main_material();
  for (const model::Material& m : simulation->scene().model().materials) {
    if (m.name != name) continue;
    const auto kind = kind_of(m.name, m.type, m.values.has("viscosity") ? m.values["viscosity"] : 0);
    if (!kind) return;
    settings.matter = *kind;
    // The other kind, where the solver can do with it; else the same.
    const std::size_t other = compared_with(*kind);
    const bool is_there = refusals[other].empty() || other_liquid(simulation->scene().model(), other);
    settings.compare_with = is_there ? other + 1 : 0;
  }
}

void PlayModel::put_stand_in() {
  const auto& [main, replaced, kind] = compared;
  if (!kind) return;
  if (const auto liquid = other_liquid(simulation->scene().model(), *kind)) {
    simulation->set_parameter(replaced, "density", liquid->density);
    simulation->set_parameter(replaced, "viscosity", liquid->viscosity);
    looks.insert_or_assign(replaced, look_of(liquid->look));
    return list_controls();
  }
  if (const std::string name = ensure_matter(*kind); name != replaced) simulation->convert(replaced, name);
}

void PlayModel::copy(const PlayModel& other, std::optional<std::size_t> kind) {
  static_cast<PlayState&>(*this) = other;
  films = other.films;
  compared.stand_in_for = other.compared.main, compared.stand_in = kind;
  if (kind) compared.main = matters()[*kind].name;
  // A simulation of the same scene takes snapshots of the other.
  simulation->restore(other.loaded->start);
  list_controls();
  put_stand_in();
  loaded = std::make_shared<LoadedScene>(LoadedScene{other.play_scene(), simulation->snapshot()});
  simulation->restore(other.simulation->snapshot());
  list_controls();
  put_stand_in();
  history.forget();
  end_tools();
}

}  // namespace dreampm::play
