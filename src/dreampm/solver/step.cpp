#include "dreampm/solver/step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/physics/particle.h"
#include "dreampm/solver/choose_dt.h"
#include "dreampm/state/volume_relaxation.h"

namespace dreampm {
namespace {

/// Cells that matter may move between sorts: stencils reach one cell beyond a block.
constexpr double drift_limit = 0.95;

/// Steps between sorts at most where there are sinks.
constexpr std::uint64_t sink_stride = 8;

/// The failure of a step: where the run stands, what is wrong, and what would help.
template <class R, class... Args>
NumericalFailure failure(const World<R>& world, fmt::format_string<Args...> what, Args&&... args) {
  const StepSettings& s = world.settings;
  return NumericalFailure(fmt::format(
      "step {} at t = {:.6g} s: {}; {}", world.step, world.time, fmt::format(what, std::forward<Args>(args)...),
      s.fixed_dt > 0 ? "lower time.dt, or give time.cfl instead" : fmt::format("lower time.cfl (now {})", s.cfl)));
}

double fastest_of(const std::vector<std::vector<ParticleSeed>>& seeds) {
  double speed = 0;
  for (const auto& set : seeds)
    for (const ParticleSeed& n : set) speed = std::max(speed, length(n.velocity));
  return speed;
}

/// Cells that any particle moves at most in a step of `dt`. No particle outruns the fastest node:
/// weights are convex. What a transfer adds is held to as much again.
template <class R>
double farthest_move(const World<R>& world, double dt) {
  return world.node_speed * world.reach() * dt / world.dx +
         (volume_relaxation_time(world, dt) > 0 ? VolumeCorrection::shift_limit : 0) +
         (world.colliders.empty() ? 0 : ColliderContact::put_back_limit);
}

/// Moves colliders to where they stand at the end of a step of `dt`, which one of world.dt_next
/// follows; whether any moved.
template <class R>
bool move_colliders(World<R>& world, double dt) {
  const double cells = world.collider_speed(dt) * dt / world.dx;
  if (cells > 1) throw failure(world, "a collider would cross {:.2f} cells in one step of {:.4g} s", cells, dt);
  bool moved = false;
  for (Collider& c : world.colliders) {
    const Pose pose = c.pose;
    const Twist twist = c.twist;
    c.advance(dt);
    c.follow(world.time + dt, world.dt_next);
    if (c.moves()) c.settle(c.slack * world.dx);
    moved = moved || c.changing || !(pose == c.pose && twist == c.twist);
  }
  wrap_bodies(world);
  return moved;
}

/// Sorts before matter has moved as far as stencils reach, with the step of `dt` that comes;
/// whether it did.
template <class R>
bool regroup_if_due(World<R>& world, Backend<R>& backend, double dt, StepAccounting<R>& accounting) {
  const double move = farthest_move(world, dt);
  if (move > drift_limit)
    throw failure(world, "matter at {:.4g} m/s would cross {:.2f} cells in one step of {:.4g} s", world.node_speed,
                  move, dt);
  // Sinks take matter when it is sorted: that of a calm pool, too.
  const bool drains = !world.sinks.empty() && world.step % sink_stride == 0;
  const bool due = drains || world.drift + move > drift_limit;
  if (due) {
    accounting.before_sort();
    backend.sort(world);
  }
  world.drift += move;
  return due;
}

}  // namespace

template <class R>
void begin(World<R>& world, Backend<R>& backend, const std::vector<std::vector<ParticleSeed>>& seeds) {
  // The backend may have run another world.
  backend.attach(world);
  PassStats stats;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (!seeds[s].empty()) stats.add(backend.insert_particles(world, s, seeds[s]));
  // They come in the order of their ids; the step wants neighbors together.
  backend.sort(world);
  world.wave_speed = stats.wave_speed;
  world.viscosity = stats.viscosity;
  world.kept_kinetic_energy = 0;
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    if (!set.transfer.keeps_velocity()) continue;
    for (const ParticleSeed& n : seeds[s])
      world.kept_kinetic_energy += kinetic_energy(set, world.dx, n.velocity, n.gradient);
  }
  choose_dt(world, fastest_of(seeds), frame_end(world) - world.time);
  if (world.aim_colliders()) backend.colliders_moved(world);
}

template <class R>
double longest_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) {
  return longest_stable_dt(world, fastest_of(seeds));
}

template <class R>
StepSums step(World<R>& world, Backend<R>& backend, Motion<R>* motion, double next_sample_time,
              BodyContacts* contacts) {
  const double dt = world.dt_next;
  const RestOfFrame frame = rest_of_frame(world, dt);
  StepAccounting<R> accounting(world, backend, frame.done);

  GridStats grid = backend.grid_update(world, dt);
  if (!grid.finite) throw failure(world, "a grid velocity is no longer finite");
  accounting.grid_updated(grid);

  if (const int stages = world.viscous_stages; stages > 0) {
    const double heat = backend.sub_cycle(world, dt, grid);
    if (!grid.finite) throw failure(world, "a grid velocity is no longer finite after {} stages of viscosity", stages);
    accounting.sub_cycled(heat);
  }

  if (!world.rigid.empty()) move_bodies(world, grid, dt, contacts);
  world.node_speed = grid.max_speed;
  choose_dt(world, world.node_speed, frame.left);
  const bool moved = move_colliders(world, dt), sorted = regroup_if_due(world, backend, dt, accounting);
  if (moved && !sorted) backend.colliders_moved(world);

  const bool sampled = frame.done || world.time + dt >= next_sample_time;
  const PassStats pass = backend.g2p2g(world, dt, world.dt_next, sampled ? motion : nullptr);
  world.formed_for(world.dt_next);
  if (!pass.finite) throw failure(world, "a particle is no longer finite");
  StepSums sums = accounting.transferred(std::move(grid), pass);

  world.wave_speed = pass.wave_speed, world.viscosity = pass.viscosity,
  world.kept_kinetic_energy = pass.energy.kept_kinetic;
  advance_clock(world, dt, frame.done);
  return sums;
}

template void begin(World<float>&, Backend<float>&, const std::vector<std::vector<ParticleSeed>>&);
template void begin(World<double>&, Backend<double>&, const std::vector<std::vector<ParticleSeed>>&);
template double longest_fixed_dt(const World<float>&, const std::vector<std::vector<ParticleSeed>>&);
template double longest_fixed_dt(const World<double>&, const std::vector<std::vector<ParticleSeed>>&);
template StepSums step(World<float>&, Backend<float>&, Motion<float>*, double, BodyContacts*);
template StepSums step(World<double>&, Backend<double>&, Motion<double>*, double, BodyContacts*);

}  // namespace dreampm
