#include "dreampm/solver/step.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/particle.h"
#include "dreampm/physics/shift.h"
#include "dreampm/solver/balance.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/state/force_fields.h"
#include "dreampm/state/volume_relaxation.h"

namespace dreampm {
namespace {

/// Cells that matter may move between sorts: stencils reach one cell beyond a block.
constexpr double drift_limit = 0.95;

template <class R>
double frame_end(const World<R>& world) {
  return world.frame / world.settings.fps;
}

/// m/s: of waves behind the hardest impact at a speed.
template <class R>
double shock(const World<R>& world, double speed) {
  double fastest = 0;
  for (const ParticleSet<R>& set : world.sets)
    if (set.size() > 0) fastest = std::max(fastest, shock_wave_speed(set.material, set.values, speed));
  return fastest;
}

/// Whether steps may be longer than explicit viscosity allows: of no law that keeps it to itself.
template <class R>
bool may_sub_cycle(const World<R>& world) {
  bool may = world.settings.sub_cycles;
  for (const ParticleSet<R>& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      if constexpr (!Viscous<M>) may = may && facts_of(M::info, set.values).kinematic_viscosity == 0;
    });
  return may;
}

/// `rule` for the fastest that is now, nodes at `node_speed`, and that fields may make within the step.
template <class R, class Rule>
StepBound bound_of(const World<R>& world, double node_speed, const Rule& rule) {
  const double speed = node_speed * world.reach();
  const auto at = [&](double v) {
    return rule(SignalSpeeds{v, world.wave_speed, shock(world, v), world.viscosity, world.viscous_contacts()});
  };
  const StepBound bound = at(speed);
  if (world.fields.empty() || !(bound.dt > 0)) return bound;
  return at(fastest_after_fields(world, speed, bound.dt));
}

/// The next step from the bounds, so that what is left of the frame is split evenly.
template <class R>
void choose_dt(World<R>& world, double node_speed, double left_of_frame) {
  const StepSettings& s = world.settings;
  const bool stages = may_sub_cycle(world);
  StepBound bound{s.fixed_dt, Limiter::user};
  if (!(s.fixed_dt > 0))
    bound = bound_of(world, node_speed, [&](const SignalSpeeds& f) {
      return stable_dt(s.cfl, world.dx, f, left_of_frame, s.dt_max, stages);
    });
  const double steps = std::max(1.0, std::ceil(left_of_frame / bound.dt * (1 - 1e-9)));
  world.dt_next = left_of_frame / steps;
  world.dt_limiter = steps == 1 ? Limiter::frame : bound.limiter;
  world.viscous_stages = stages ? stages_of(world.dt_next, world.dx, world.viscosity, world.viscous_contacts()) : 0;
}

double fastest_of(const std::vector<std::vector<ParticleSeed>>& seeds) {
  double speed = 0;
  for (const auto& set : seeds)
    for (const ParticleSeed& n : set) speed = std::max(speed, length(n.velocity));
  return speed;
}

template <class R>
double mass_of(const World<R>& world) {
  double mass = 0;
  for (const auto& set : world.sets) mass += set.mass * static_cast<double>(set.size());
  return mass;
}

/// The momentum and angular momentum of all nodes, which hold velocities after grid_update and momenta between steps.
template <class R>
ImpulseSum on_the_grid(const World<R>& world, bool velocities) {
  const auto add_block = [&](ImpulseSum& sum, std::size_t b) {
    for (const auto* field : {&world.grid.nodes, &world.grid.solids}) {
      if (field->empty()) continue;
      for (int n = 0; n < block_nodes; ++n) {
        const Node<R>& node = (*field)[b * block_nodes + static_cast<std::size_t>(n)];
        if (!(node.m > R(0))) continue;
        const Vec3d p =
            static_cast<Vec3d>(Vec3<R>{node.x, node.y, node.z}) * (velocities ? static_cast<double>(node.m) : 1);
        sum.impulse += p;
        sum.angular += cross(world.node_position(world.grid.blocks[b] * block_width + node_offset(n)), p);
      }
    }
  };
  return parallel_reduce(world.grid.blocks.size(), ImpulseSum{}, add_block);
}

/// What acts on all matter alike, and how far rounding may move the sums in this step: a few roundings of all that
/// moves. The sum of m |v| is at most sqrt(2 M K) (Cauchy-Schwarz).
template <class R>
void account(const World<R>& world, double dt, double mass, StepSums& report) {
  const Vec3d kick = world.gravity_over(dt) * dt;
  report.body = report.grid.damping;
  report.body.work = 0;
  report.body += report.grid.fields;
  report.body += {kick * mass, cross(report.grid.moment, kick), 0};
  report.body.work -= dot(world.gravity_at(world.time + dt) - world.gravity_at(world.time), report.grid.moment);
  report.rounding = roundings * static_cast<double>(std::numeric_limits<R>::epsilon()) *
                    (std::sqrt(2 * mass * report.grid.kinetic) + mass * length(kick));
}

/// Of a step that failed.
std::string remedy(const StepSettings& s) {
  return s.fixed_dt > 0 ? "lower time.dt, or give time.cfl instead" : fmt::format("lower time.cfl (now {})", s.cfl);
}

}  // namespace

template <class R>
void begin(World<R>& world, Backend<R>& backend, const std::vector<std::vector<ParticleSeed>>& seeds) {
  // The backend may have run another world.
  backend.attach(world);
  PassStats stats;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (!seeds[s].empty()) stats.add(backend.insert_particles(world, s, seeds[s]));
  // They come in the order of their ids; the step wants neighbours together.
  backend.sort(world);
  world.wave_speed = stats.wave_speed;
  world.viscosity = stats.viscosity;
  world.keeping = 0;
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    if (!set.transfer.keeps_velocity()) continue;
    for (const ParticleSeed& n : seeds[s]) world.keeping += kinetic_energy(set, world.dx, n.velocity, n.gradient);
  }
  choose_dt(world, fastest_of(seeds), frame_end(world) - world.time);
}

template <class R>
double longest_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) {
  const bool stages = may_sub_cycle(world);
  const StepBound bound = bound_of(world, fastest_of(seeds), [&](const SignalSpeeds& f) {
    return stages ? wave_bound(largest_cfl, world.dx, f) : stable_dt(largest_cfl, world.dx, f, 1e30, 1e30, false);
  });
  return bound.dt;
}

template <class R>
StepSums step(World<R>& world, Backend<R>& backend, Motion<R>* motion, double next_sample_time) {
  StepSums report;
  const double dt = world.dt_next;
  report.dt = dt;
  report.limiter = world.dt_limiter;
  report.stages = world.viscous_stages;

  report.grid = backend.grid_update(world, dt);
  if (!report.grid.finite)
    throw NumericalFailure(fmt::format("step {} at t = {:.6g} s: a grid velocity is no longer finite; {}", world.step,
                                       world.time, remedy(world.settings)));

  const double mass = mass_of(world);
  account(world, dt, mass, report);
  double heat = 0;
  if (world.viscous_stages > 0) {
    heat = backend.sub_cycle(world, dt, report.grid);
    report.rounding *= 1 + world.viscous_stages;
    if (!report.grid.finite)
      throw NumericalFailure(
          fmt::format("step {} at t = {:.6g} s: a grid velocity is no longer finite after {} stages of viscosity; {}",
                      world.step, world.time, world.viscous_stages, remedy(world.settings)));
  }

  double left = frame_end(world) - world.time - dt;
  report.frame_done = left <= 1e-6 * dt;
  const double next_end = (world.frame + 1) / world.settings.fps;
  choose_dt(world, report.grid.max_speed, report.frame_done ? next_end - frame_end(world) : left);

  // No particle outruns the fastest node: weights are convex. What a transfer adds is held to as much again.
  const bool relaxes = volume_relaxation_time(world, dt) > 0;
  world.node_speed = report.grid.max_speed;
  const double move = report.grid.max_speed * world.reach() * dt / world.dx + (relaxes ? shift_limit : 0) +
                      (world.colliders.empty() ? 0 : put_back_limit);
  if (move > drift_limit)
    throw NumericalFailure(
        fmt::format("step {} at t = {:.6g} s: matter at {:.4g} m/s would cross {:.2f} cells in one step of {:.4g} s; "
                    "{}",
                    world.step, world.time, report.grid.max_speed, move, dt, remedy(world.settings)));
  std::optional<ImpulseSum> before_leaving;
  if (world.drift + move > drift_limit) {
    const bool may_leave =
        std::any_of(world.walls.begin(), world.walls.end(), [](const Wall& w) { return w.type == WallType::open; });
    const std::uint64_t left_before = world.left;
    if (may_leave) before_leaving = on_the_grid(world, true);
    backend.sort(world);
    if (world.left == left_before) before_leaving.reset();
  }
  world.drift += move;

  const bool look = report.frame_done || world.time + dt >= next_sample_time;
  report.pass = backend.g2p2g(world, dt, world.dt_next, look ? motion : nullptr);
  if (!report.pass.finite)
    throw NumericalFailure(fmt::format("step {} at t = {:.6g} s: a particle is no longer finite; {}", world.step,
                                       world.time, remedy(world.settings)));
  if (before_leaving) {
    // Stresses give nothing in sum: what the grid lacks now is what left.
    const ImpulseSum now = on_the_grid(world, false);
    report.left.impulse = before_leaving->impulse - now.impulse;
    report.left.angular = before_leaving->angular - now.angular;
    report.left_mass = mass - mass_of(world);
  }
  // A kept velocity is not the grid's: what the grid cannot see of it comes back in the gather, and counts both ways.
  // What left is missing in the pass.
  if (report.left_mass == 0)
    report.transfer = world.keeping - report.grid.arrived + report.grid.kinetic - report.pass.energy.kinetic;
  world.keeping = report.pass.energy.keeping;
  report.pass.energy.viscous += heat;
  // What liquids are shifted by is part of their volume relaxation; what colliders put back counts with it.
  report.body.angular += report.pass.turned;
  report.pass.energy.relaxed += dot(world.gravity_at(world.time + dt), report.pass.shifted);
  if (relaxes) report.swollen = report.pass.swollen;
  world.wave_speed = report.pass.wave_speed;
  world.viscosity = report.pass.viscosity;
  ++world.step;
  if (report.frame_done) {
    world.time = frame_end(world);
    ++world.frame;
  } else {
    world.time += dt;
  }
  return report;
}

template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion) {
  const MotionById<R> by_id(world, motion);
  backend.sort(world);
  motion = by_id.ordered(world);
  const PassStats stats = backend.state_bounds(world);
  if (!stats.finite)
    throw NumericalFailure(fmt::format("an edit at t = {:.6g} s leaves particles that are not finite", world.time));
  world.wave_speed = stats.wave_speed;
  world.viscosity = stats.viscosity;
  double fastest = 0;
  world.keeping = 0;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    const auto& m = motion.sets[s];
    for (std::size_t p = 0; p < set.size(); ++p) {
      const auto v = static_cast<Vec3d>(m.velocity[p]);
      const auto c = static_cast<Mat3d>(m.gradient[p]);
      // No node is faster than a particle together with its affine motion over a cell.
      fastest = std::max(fastest, length(v) + std::sqrt(norm2(c)) * world.dx);
      if (set.transfer.keeps_velocity()) world.keeping += kinetic_energy(set, world.dx, v, c);
    }
  }
  choose_dt(world, fastest, frame_end(world) - world.time);
  backend.scatter_particles(world, motion);
}

template void begin(World<float>&, Backend<float>&, const std::vector<std::vector<ParticleSeed>>&);
template void begin(World<double>&, Backend<double>&, const std::vector<std::vector<ParticleSeed>>&);
template double longest_fixed_dt(const World<float>&, const std::vector<std::vector<ParticleSeed>>&);
template double longest_fixed_dt(const World<double>&, const std::vector<std::vector<ParticleSeed>>&);
template void form_grid(World<float>&, Backend<float>&, Motion<float>&);
template void form_grid(World<double>&, Backend<double>&, Motion<double>&);
template StepSums step(World<float>&, Backend<float>&, Motion<float>*, double);
template StepSums step(World<double>&, Backend<double>&, Motion<double>*, double);

}  // namespace dreampm
