#include "dreampm/pipeline/preflight.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/seconds_since.h"
#include "dreampm/physics/dt.h"
#include "dreampm/physics/param.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/fill_report.h"
#include "dreampm/run/scene_engine.h"
#include "dreampm/setup/fixed_dt.h"
#include "dreampm/setup/inflow.h"
#include "dreampm/setup/start.h"
#include "dreampm/solver/projection/solids.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

/// The part of the output folder's path that is there already.
fs::path existing_folder(const fs::path& folder, const std::string& file) {
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there))
    fail_input("{}: error: output.folder is {}, but {} is a file; name another folder", file, folder.string(),
               there.string());
  if (::access(there.c_str(), W_OK) != 0)
    fail_input("{}: error: output.folder is {}, but nothing may be written in {} ({}); name another folder", file,
               folder.string(), there.string(), system_reason());
  return there;
}

/// The bound of explicit steps of matter at rest pressure and the largest expected speed; of a
/// projection that of the matter in its liquid.
StepBound explicit_bound(const InitialState& start, const model::Scene& scene) {
  const bool projects = scene.time.solver == SolverKind::projection;
  SignalSpeeds fastest{start.expected.speed, 0, 0, 0, 0};
  for (const auto& set : start.world.sets) {
    if (projects && is_projected(set)) continue;
    const MaterialFacts facts = facts_of(*find_material(set.material), set.values);
    fastest.wave = std::max(fastest.wave, facts.sound_speed);
    fastest.viscosity = std::max(fastest.viscosity, facts.kinematic_viscosity);
  }
  return stable_dt(projects ? StepSettings{}.cfl : scene.time.cfl, start.world.dx, fastest, 1 / scene.time.fps,
                   scene.time.dt_max.value_or(1e30));
}

/// The same of the steps of the scene's solver.
StepBound bound_of_expected(const InitialState& start, const model::Scene& scene) {
  if (scene.time.solver == SolverKind::projection)
    return projection_bound(scene.time.cfl, start.world.dx, length(scene.gravity),
                            {start.expected.speed, start.expected.speed}, block_width);
  return explicit_bound(start, scene);
}

}  // namespace

Preflight preflight(const model::Scene& scene, const std::string& file) {
  std::string errors;
  fs::path disk;
  std::unique_ptr<SceneEngine<float>> begun;
  try {
    disk = existing_folder(scene.output.folder, file);
  } catch (const InputError& e) {
    errors = e.what();
  }
  try {
    begun = std::make_unique<SceneEngine<float>>(scene, file, make_cpu_backend());
  } catch (const InputError& e) {
    errors += (errors.empty() ? "" : "\n") + std::string(e.what());
  }
  for (const std::string& e : refused_later(scene))
    errors += fmt::format("{}{}: error: {}", errors.empty() ? "" : "\n", file, e);
  if (!errors.empty()) throw InputError(errors);
  Engine<float>& engine = begun->engine();
  InitialState& start = begun->start();
  const World<float>& world = std::as_const(engine).world();
  begun->begin();
  Preflight p;
  p.particles = start.particles();
  p.dx = world.dx;
  p.dt = world.dt_next;
  p.limiter = std::string(name_of(world.dt_limiter));
  p.stages = world.viscous_stages;
  p.substeps_per_frame = 1 / (scene.time.fps * world.dt_next);
  const double end = (scene.time.frames - 1) / scene.time.fps;
  p.inflow = most_inflow(start.world, end);
  if (p.inflow > 0) {
    // Before matter is there nothing limits a step.
    const StepBound bound = bound_of_expected(start, scene);
    if (bound.dt < p.dt) {
      p.dt = bound.dt, p.limiter = std::string(name_of(bound.limiter));
      p.substeps_per_frame = 1 / (scene.time.fps * p.dt);
    }
  }
  if (scene.time.solver == SolverKind::projection && has_solids(start.world))
    p.solid_steps = std::ceil(p.dt / explicit_bound(start, scene).dt);
  const std::size_t most = p.particles + p.inflow;
  const StageEstimate later = estimate_stages(scene, most);
  // Reading meshes and filling them has just been done: it took what it takes.
  p.memory_bytes = std::max(memory_estimate(most, !scene.colliders.empty()), peak_memory_bytes()) + later.memory_bytes;
  p.disk_bytes = disk_estimate(scene, most);
  if (std::string w = disk_shortage(p.disk_bytes, disk); !w.empty()) start.warnings.push_back(std::move(w));
  if (const std::string w = too_many_stages(world); !w.empty()) start.warnings.push_back(w);
  p.warnings = std::move(start.warnings);
  p.notes = std::move(start.notes);
  HollowLines hollows = hollow_lines(scene, regions_of(start.world.colliders));
  p.warnings.insert(p.warnings.end(), hollows.warnings.begin(), hollows.warnings.end());
  p.notes.insert(p.notes.end(), hollows.notes.begin(), hollows.notes.end());
  // The rate is measured here and now, on this very scene.
  engine.step();
  const auto clock = Clock::now();
  int steps = 0;
  while (steps < 3 || (seconds_since(clock) < 0.3 && steps < 1000)) engine.step(), ++steps;
  const double step = seconds_since(clock) / steps;
  // Of what comes in half is there in the mean; a few particles say nothing of what one takes.
  constexpr std::size_t enough = 20000;
  double each = p.particles >= enough ? step / static_cast<double>(p.particles)
                                      : simulate_per_particle / std::max(1, thread_count());
  // What is poured may be what takes explicit steps, and none of it is there yet.
  const bool pours_solids = std::any_of(start.world.emitters.begin(), start.world.emitters.end(),
                                        [&](const Emitter& e) { return !is_projected(start.world.sets[e.set]); });
  if (p.solid_steps > 0 && pours_solids)
    each = std::max(each, p.solid_steps * simulate_per_particle / std::max(1, thread_count()));
  p.simulate_seconds = (step + each * 0.5 * static_cast<double>(p.inflow)) * p.substeps_per_frame *
                       (scene.time.frames - first_frame(scene));
  return p;
}

}  // namespace dreampm
