#include "dreampm/run/scene_engine.h"

#include "dreampm/backend/registry.h"
#include "dreampm/base/log.h"
#include "dreampm/setup/fixed_dt.h"
#include "dreampm/setup/place.h"
#include "dreampm/setup/start.h"

namespace dreampm {

template <class R>
SceneEngine<R>::SceneEngine(const model::Scene& scene, const std::string& file, InitialState start,
                            std::unique_ptr<Backend<R>> backend)
    : start_(std::move(start)),
      dt_place_(place(file, scene, "time.dt")),
      moment_(scene.start),
      time_(scene.time),
      engine_(as_world<R>(start_.world), std::move(backend)),
      probes_(engine_, ProbeSet<R>(scene, start_, file)) {
  engine_.add(probes_);
  const std::string_view name = engine_.backend().name();
  if (start_.world.settings.solver == SolverKind::projection && has_device(name))
    warn("{}: time.solver: projection computes on the processor, with the backend {} too; explicit uses its device",
         file, name);
}

template <class R>
void SceneEngine<R>::begin() {
  if (moment_.empty()) {
    engine_.begin(start_.seeds);
  } else {
    World<R> world = engine_.world();
    Motion<R> motion;
    const bool same = read_start(moment_, time_.frames, world, motion);
    engine_.replace(std::move(world), &motion);
    if (!same) engine_.form_grid();
  }
  check_fixed_dt(engine_.world(), start_.seeds, time_, dt_place_);
}

template <class R>
void SceneEngine<R>::go_on(World<R> saved, const ProbeMemories& memories) {
  engine_.replace(std::move(saved), nullptr);
  probes_.set().resume(memories, engine_.world().time);
}

template class SceneEngine<float>;
template class SceneEngine<double>;

}  // namespace dreampm
