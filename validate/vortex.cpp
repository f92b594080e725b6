#include "validate/vortex.h"

#include <cmath>
#include <numbers>

#include "validate/measure/hydrostatic.h"
#include "validate/measure/motion.h"

namespace dreampm::validate {
namespace {

constexpr double k = std::numbers::pi, speed = 1, filled = 1.01;

}  // namespace

VortexDecay vortex_decay(Trial& trial, int cells, double nu, const VortexLiquid& liquid) {
  const double dx = 1.0 / cells;
  // The liquid lies 1 % denser than at rest: its nu is that of its true density.
  std::vector<std::string> all{fmt::format("materials.liquid.viscosity={:.17g}", 1000 * filled * nu * liquid.factor)};
  all.push_back("materials.liquid.transfer=" + liquid.transfer);
  if (liquid.flip_blend) all.push_back(fmt::format("materials.liquid.flip_blend={:.17g}", *liquid.flip_blend));
  all.push_back(fmt::format("seed={}", liquid.seed));
  all.push_back(fmt::format("time.damping={:.17g}", liquid.damping));
  all.push_back(fmt::format("space.spacing={:.17g}", dx / 2));
  all.push_back(fmt::format("space.max=[1,1,{:.17g}]", 4 * dx));
  all.push_back(fmt::format("bodies.liquid.shape={{box: {{min: [0,0,0], max: [1,1,{:.17g}]}}}}", 4 * dx));
  ValidationRun<float> run(trial, "taylor-green", all);
  ParticleSet<float>& set = run.world.sets[0];
  set.mass *= filled, set.rest_volume *= filled;  // more matter on the same points
  for (ParticleSeed& n : run.seeds[0])
    set_motion(
        n,
        [](const Vec3d& p) {
          return Vec3d{std::sin(k * p.x) * std::cos(k * p.y), -std::cos(k * p.x) * std::sin(k * p.y), 0} * speed;
        },
        1e-5);
  run.begin();
  // The pressure that belongs to the vortex, over that of the filling.
  const Hydrostatic law(set.values, 1, 1);
  const double base = law.pressure(1 / filled - 1), half = set.values["density"] * speed * speed / 4;
  auto& e = state_column(set, "e");
  each_particle(run.world, [&](std::size_t, std::size_t p, const Vec3d& at) {
    e[p] = static_cast<float>(law.strain(base + half * (std::cos(2 * k * at.x) + std::cos(2 * k * at.y))));
  });
  VortexDecay r;
  r.exact_rate = -4 * k * k * nu;  // of ln KE in a box of 1 m
  // Until a third is left, at most a second: two or three turns at Re = 100.
  const double end = std::min(1.0, 1.5 / -r.exact_rate);
  r.times.push_back(0);
  std::vector<double> energy{balance(run.world, initial_velocities(run.world, run.seeds)).kinetic};
  Motion<float> motion;
  double heat = 0;
  while (run.world.time < end) {
    const StepSums step = run.step(&motion);
    heat += step.pass.energy.viscous;
    if (!step.frame_done) continue;
    energy.push_back(balance(run.world, motion).kinetic);
    r.times.push_back(run.world.time);
  }
  r.pace = static_cast<double>(run.world.step) / run.world.time;
  r.heat = heat / (energy.front() - energy.back());
  for (const double ke : energy) r.log_energy.push_back(std::log(ke / energy[0]));
  std::vector<double> t, log_ke;
  for (std::size_t i = 0; i < r.times.size(); ++i)
    if (r.times[i] >= 0.1 * end) t.push_back(r.times[i]), log_ke.push_back(r.log_energy[i]);
  const double rate = slope_of(t, log_ke);
  r.rate = rate / r.exact_rate;
  r.excess = (r.exact_rate - rate) / (4 * k * k);
  return r;
}

std::vector<VortexDecay> vortex_decays(Trial& trial, int cells, double nu, VortexLiquid liquid) {
  std::vector<VortexDecay> draws;
  for (liquid.seed = 1; liquid.seed <= vortex_draws; ++liquid.seed)
    draws.push_back(vortex_decay(trial, cells, nu, liquid));
  return draws;
}

}  // namespace dreampm::validate
