#include "bench/large_steps.h"

#include <cmath>

#include "bench/moment.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/solver/projection/projection.h"

namespace dreampm {
namespace {

/// Steps of a window that begins anew: half a frame of a splash.
constexpr int steps_per_piece = 4;

}  // namespace

LargeSteps::LargeSteps(Waters waters, const Vec3i& cells, std::string_view isa) : backend_(make_cpu_backend(isa)) {
  const MaterialInfo& water = *find_material("newtonian");
  BenchScene scene = waters == Waters::calm ? tank_scene(water, cells) : column_scene(water, cells);
  World<float>& w = scene.world;
  w.settings.solver = SolverKind::projection, w.settings.cfl = usual_projection_cfl;
  w.sets[0].carries_motion = true;
  auto world = std::make_unique<World<float>>(std::move(scene.world));
  Projection<float> solver(backend_.get());
  Motion<float> motion;
  solver.begin(*world, scene.seeds);
  scene.seeds = {};
  // The front has come to the other wall, and what climbed it falls back.
  const double height = cells.y * world->dx, end = waters == Waters::calm ? 0.2 : 2.5 * std::sqrt(height / 9.81);
  while (world->time < end) solver.step(*world, motion, 1e30, nullptr);
  start_ = std::move(world);
}

Timing LargeSteps::run(const Pace& pace) const {
  const auto particles = static_cast<double>(start_->particles());
  Projection<float> solver(backend_.get());
  Motion<float> motion;
  Timing timing;
  {
    World<float> world = *start_;  // arrays of the solver become warm
    for (int i = 0; i < 2; ++i) solver.step(world, motion, 1e30, nullptr);
  }
  for (int window = 0; window < pace.windows; ++window) {
    double wall = 0, cpu = 0;
    long long steps = 0;
    while (steps == 0 || wall < pace.window_seconds) {
      World<float> world = *start_;
      const Moment begun;
      for (int i = 0; i < steps_per_piece; ++i, ++steps) solver.step(world, motion, 1e30, nullptr);
      const Moment end;
      wall += end.wall - begun.wall, cpu += end.cpu - begun.cpu;
    }
    const double per = 1e9 / static_cast<double>(steps) / particles;
    timing.windows.push_back(wall * per), timing.cpu_windows.push_back(cpu * per);
    if (pace.each) pace.each(wall * per, cpu * per);
  }
  return timing;
}

}  // namespace dreampm
