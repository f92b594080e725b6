#include "bench/solvers.h"

#include <algorithm>

#include "bench/moment.h"
#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/run/scene_engine.h"

namespace dreampm {
namespace {

class Turn {
 public:
  Turn(model::Scene scene, SolverKind solver) {
    scene.time.solver = solver;
    for (model::Body& b : scene.bodies) b.pattern = Pattern::jitter;
    if (solver == SolverKind::projection) {
      scene.time.cfl = usual_projection_cfl;
      for (model::Material& m : scene.materials) m.transfer = "apic", m.transfer_values = {};
    } else if (scene.time.cfl > largest_cfl) {
      scene.time.cfl = model::Time{}.cfl;
    }
    scene_ = std::make_unique<SceneEngine<float>>(scene, scene.name, make_cpu_backend());
    scene_->begin();
    scene_->start() = {};
  }
  void to_frame(int frame, SolverCost& cost) {
    const Moment begun;
    Engine<float>& engine = scene_->engine();
    while (engine.world().frame < frame) {
      cost.particle_steps += engine.world().particles(), ++cost.steps;
      engine.step();
    }
    cost.cpu_seconds += Moment().cpu - begun.cpu;
  }
  std::uint64_t particles() const { return scene_->engine().world().particles(); }

 private:
  std::unique_ptr<SceneEngine<float>> scene_;
};

}  // namespace

SolversCost bench_solvers(const model::Scene& scene, int frames,
                          const std::function<void(int, const SolversCost&)>& each) {
  const ThreadLimit one(1);
  Turn projection(scene, SolverKind::projection), explicit_steps(scene, SolverKind::explicit_steps);
  SolversCost cost;
  for (int frame = 2; frame <= std::min(frames, scene.time.frames); ++frame) {
    projection.to_frame(frame, cost.projection);
    explicit_steps.to_frame(frame, cost.explicit_steps);
    cost.particles = projection.particles();
    if (each) each(frame, cost);
  }
  return cost;
}

}  // namespace dreampm
