// Random scenes run for some hundred steps: numbers stay numbers, nothing is lost, and steps do not shrink.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "dreampm/base/parallel.h"
#include "dreampm/validate/draw.h"
#include "dreampm/validate/measure/particles.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

struct Outcome {
  std::string fault;    ///< empty: a clean draw
  double shortest = 0;  ///< step over its floor
  double energy = 0;    ///< largest kinetic energy over that of the fall
  std::string scene;
  std::uint64_t particle_steps = 0;
};

/// What is wrong with the world, which began with so many particles; empty if nothing.
std::string fault_of(const World<float>& w, std::size_t particles) {
  if (w.particles() != particles || w.left != 0)
    return fmt::format("{} of {} particles are left", w.particles(), particles);
  std::size_t strange = 0, outside = 0;
  const Vec3d high = w.origin + static_cast<Vec3d>(w.high - w.low) * w.dx;
  each_particle(w, [&](std::size_t s, std::size_t p, const Vec3d& at) {
    bool finite = true;
    for (int a = 0; a < 3; ++a) finite = finite && std::isfinite(at[a]);
    for (const auto& c : w.sets[s].state) finite = finite && std::isfinite(c[p]);
    strange += !finite;
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && at[a] >= w.origin[a] - 1e-5 * w.dx && at[a] <= high[a] + 1e-5 * w.dx;
    outside += finite && !inside;
  });
  if (strange) return fmt::format("{} particles have something that is not a number", strange);
  if (outside) return fmt::format("{} particles are outside of the walls", outside);
  return {};
}

Outcome run_draw(const Options& options, const Draw& draw) {
  Outcome o;
  o.scene = draw.text;
  o.shortest = 1e30;
  Trial own(options);
  try {
    Run<float> run(own, draw.scene);
    run.begin();
    const std::size_t particles = run.world.particles();
    double mass = 0;
    for (const auto& set : run.world.sets) mass += set.mass * static_cast<double>(set.size());
    const double energy = mass * draw.fall * draw.fall / 2;
    for (int n = 1; n <= draw_steps && o.fault.empty(); ++n) {
      const StepReport r = run.step();
      o.shortest = std::min(o.shortest, r.dt / draw.dt_floor);
      o.energy = std::max(o.energy, r.pass.energy.kinetic / energy);
      if (r.dt < draw.dt_floor)
        o.fault = fmt::format("a step of {:.3g} s, under the floor of {:.3g} s", r.dt, draw.dt_floor);
      // Sums over nodes in float.
      else if (!(std::abs(r.grid.mass / mass - 1) < 1e-4))
        o.fault = fmt::format("the grid holds {:.6g} of the mass", r.grid.mass / mass);
      else if (n % 50 == 0)
        o.fault = fault_of(run.world, particles);
      if (!o.fault.empty()) o.fault = fmt::format("step {}: {}", n, o.fault);
    }
  } catch (const RunError& e) {
    o.fault = e.what();
  }
  o.particle_steps = own.particle_steps;
  return o;
}

/// Draws side by side, each on one thread; the outcomes in the draws' order.
std::vector<Outcome> run_draws(const Options& options, const std::vector<Draw>& draws) {
  std::vector<Outcome> all(draws.size());
  parallel_for(draws.size(), 1, [&](std::size_t i) { on_this_thread([&] { all[i] = run_draw(options, draws[i]); }); });
  return all;
}

void run(Trial& t) {
  const Options& o = t.options();
  const int count = o.draws > 0 ? o.draws : t.full() ? 200 : 12;
  std::vector<Draw> draws;
  if (o.draw >= 0)
    draws.push_back(draw_scene(o.seed, o.draw));
  else
    for (int i = 0; i < count; ++i) draws.push_back(draw_scene(o.seed, i));
  const auto outcomes = run_draws(o, draws);
  int failed = 0;
  double shortest = 1e30, energy = 0;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Outcome& r = outcomes[i];
    t.cost(r.particle_steps);
    shortest = std::min(shortest, r.shortest), energy = std::max(energy, r.energy);
    if (r.fault.empty()) continue;
    ++failed;
    t.attach({draws[i].scene.name + ".yaml", r.fault, r.scene});
  }
  const std::string name = fmt::format("draws of seed {} that failed, of {}", o.seed, draws.size());
  t.at_most(name, failed, 0);
  t.tell("shortest step over its floor", shortest);
  // Told, not judged: an anchor may still press badly packed stiff matter harder than its fall did.
  t.tell("largest kinetic energy over that of the fall", energy);
  // The bound of the step is there for a reason: some of a few scenes must break with six times it.
  std::vector<Draw> wrong;
  for (int i = 0; i < 4; ++i) {
    wrong.push_back(draw_scene(1, i));
    wrong.back().scene.time.cfl = 3;
  }
  const auto noticed = run_draws(o, wrong);
  t.control("steps of 3 cells", name,
            static_cast<double>(
                std::count_if(noticed.begin(), noticed.end(), [](const Outcome& r) { return !r.fault.empty(); })));
}

}  // namespace

extern const Case stability;
const Case stability{
    "stability",
    "scenes by chance: no NaN, nothing lost, no step under its floor (--draws, --seed, --draw)",
    "conservation of mass; of energy, which bounds how fast and how stiff matter can get, and so the step",
    true,
    run,
    15,
    35};

}  // namespace dreampm::validate::cases
