#include "dreampm/solver/projection/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/base/error.h"
#include "dreampm/solver/choose_dt.h"
#include "dreampm/solver/projection/collider_steps.h"
#include "dreampm/solver/projection/forces.h"
#include "dreampm/solver/projection/pressure.h"
#include "dreampm/solver/projection/step_length.h"
#include "dreampm/state/mechanics.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// kg/m^3
template <class R>
double density_of(const World<R>& world) {
  const ParticleSet<R>* const liquid = liquid_of(world);
  return liquid ? liquid->mass / liquid->rest_volume : 0;
}
/// m^2/s
template <class R>
double viscosity_of(const World<R>& world) {
  const ParticleSet<R>* const liquid = liquid_of(world);
  return liquid ? liquid->values["viscosity"] / liquid->values["density"] : 0;
}

/// Returns the walls and colliders that matter may leave. `scale`: Pa for each of the pressure's
/// units.
template <class R>
Leaving what_lets_go(const World<R>& world, double scale) {
  Leaving leaving;
  const auto pull = [&](WallType type, double sticky) {
    return type == WallType::separate ? sticky / scale : Leaving::never;
  };
  for (std::size_t w = 0; w < 6; ++w) leaving.walls[w] = pull(world.walls[w].type, 0);
  for (const Collider& c : world.colliders) leaving.colliders.push_back(pull(c.contact(), c.sticky));
  return leaving;
}

/// Throws InputError where the world has something that scenes are refused for: edits could bring
/// it.
template <class R>
void refuse_unknown(const World<R>& world) {
  const auto refuse = [](const std::string& what) {
    fail_input("time.solver: projection moves liquids between walls and colliders, and cannot do with {}", what);
  };
  const ParticleSet<R>* const liquid = liquid_of(world);
  for (const ParticleSet<R>& set : world.sets) {
    if (!is_projected(set)) {
      if (!liquid) refuse(fmt::format("material {}, for there is no liquid", set.name));
      continue;
    }
    for (const char* value : {"density", "viscosity"})
      if (set.values[value] != liquid->values[value])
        refuse(fmt::format("materials {} and {} that differ in {}", liquid->name, set.name, value));
  }
  for (const Collider& c : world.colliders)
    if (c.holds) refuse(fmt::format("collider {}, which holds what is inside of it", c.name));
}

/// Carries the pressure of the former blocks, in order, over to the present ones; new blocks get 0.
template <class R>
void carry_pressure(World<R>& world, const std::vector<Vec3i>& former) {
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  if (blocks == former) return;
  LargeVector<R> carried(blocks.size() * block_nodes, R(0));
  parallel_ranges(blocks.size(), 128, [&](std::size_t begin, std::size_t end) {
    auto old = std::lower_bound(former.begin(), former.end(), blocks[begin], block_less);
    for (std::size_t b = begin; b < end; ++b) {
      while (old != former.end() && block_less(*old, blocks[b])) ++old;
      if (old != former.end() && *old == blocks[b])
        std::copy_n(world.cell_pressure.data() + (old - former.begin()) * block_nodes, block_nodes,
                    carried.data() + b * block_nodes);
    }
  });
  world.cell_pressure.swap(carried);
}

}  // namespace

template <class R>
void Projection<R>::begin(World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) {
  double fastest = 0;
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    if (!seeds[s].empty()) dreampm::insert<R>(world, s, seeds[s]);
    for (const ParticleSeed& n : seeds[s]) fastest = std::max(fastest, length(n.velocity));
  }
  regroup_(world, spare_);
  world.cell_pressure.assign(world.grid.blocks.size() * block_nodes, R(0));
  world.dt_before = 0;
  Motion<R> motion;
  take_carried_motion(world, motion);
  world.kept_kinetic_energy = kinetic_of(world) + kinetic_of_solids(world, motion);
  choose_projection_dt(world, {fastest, fastest}, frame_end(world) - world.time);
  world.aim_colliders();
}

template <class R>
PassStats Projection<R>::insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) {
  const std::vector<Vec3i> former = world.grid.blocks.all();
  dreampm::insert(world, set, seeds);
  carry_pressure(world, former);
  return {};
}

template <class R>
void Projection<R>::form_grid(World<R>& world, Motion<R>& motion) {
  solids_.add_shown(world, -1, motion);
  for (std::size_t s = 0; s < world.sets.size(); ++s) carry_motion(motion.sets[s], Vec3<R>{}, world.sets[s]);
  const FlowSpeeds flow = flow_speeds(world);
  if (!std::isfinite(flow.fastest))
    throw NumericalFailure(fmt::format("an edit at t = {:.6g} s leaves particles that are not finite", world.time));
  // An edit may have laid other blocks already.
  if (world.cell_pressure.size() != world.grid.blocks.size() * block_nodes)
    world.cell_pressure.assign(world.grid.blocks.size() * block_nodes, R(0));
  const std::vector<Vec3i> former = world.grid.blocks.all();
  regroup_(world, spare_);
  carry_pressure(world, former);
  take_carried_motion(world, motion);
  solids_.add_shown(world, 1, motion);
  world.kept_kinetic_energy = kinetic_of(world) + kinetic_of_solids(world, motion);
  choose_projection_dt(world, flow, frame_end(world) - world.time);
  world.aim_colliders();
}

template <class R>
void Projection<R>::set_up_matrix() {
  const Vec3i size = grid_.high - grid_.low;
  solver_.begin(grid_.cells, std::max({size.x, size.y, size.z}));
  fill_matrix(grid_, solver_.matrix());
  solver_.set_up();
  // Only colliders can part liquid from its surface, unless it fills the whole box.
  const auto room = static_cast<double>(size.x) * size.y * size.z;
  if (!grid_.room.empty() || static_cast<double>(solver_.matrix().rows.size()) * row_cells >= room)
    solver_.find_pockets();
  solver_.balance_pockets();
}

template <class R>
void Projection<R>::take_last_pressure(const World<R>& world, double scale) {
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  if (world.cell_pressure.size() != blocks.size() * block_nodes) return;
  parallel_for(blocks.size(), 64, [&](std::size_t b) {
    const R* const pressure = world.cell_pressure.data() + b * block_nodes;
    grid_.cells.for_block_rows(blocks[b], [&](std::size_t n, std::size_t at) {
      for (std::size_t k = 0; k < block_width; ++k)
        grid_.impulse[at + k] = grid_.depth[at + k] > R(0) ? pressure[n + k] / static_cast<R>(scale) : R(0);
    });
  });
  grid_.wrap(grid_.impulse);
}

template <class R>
double Projection<R>::slow_by_viscosity(World<R>& world, double kick) {
  viscosity_iterations_ = 0;
  viscosity_.leave_out();
  const double nu = viscosity_of(world);
  if (!(nu > 0)) return 0;
  std::array<bool, 6> walls;
  for (std::size_t w = 0; w < 6; ++w) walls[w] = world.walls[w].skin_friction;
  if (world.has_skin_friction()) slow_along_walls(grid_, walls, {nu, world.dx, kick});
  const double diffusion = nu * kick / (world.dx * world.dx);
  if (diffusion < ProjectionNumbers::least_diffusion) return 0;
  // Velocities that viscosity is to act on have felt a pressure: the last one, for as long. Else
  // liquid would slip along what holds it, by what the pressure changes later.
  const auto press = [&](double sign) {
    add_pressure(grid_, sign);
    if (!bodies_.any()) return;
    bodies_.move_bodies(world, grid_.impulse, sign);
    cut_.see(world), cut_.find_velocities(world, grid_);
  };
  bodies_.find_cells(world, grid_, cut_);
  press(1);
  const ViscousSolve solved = viscosity_.solve(world, grid_, cut_, bodies_, diffusion, density_of(world));
  press(-1);
  viscosity_iterations_ = solved.iterations;
  return solved.heat * density_of(world) * world.dx * world.dx * world.dx;
}

template <class R>
void Projection<R>::solve_pressure(const World<R>& world, const Leaving& leaving) {
  set_up_matrix();
  const double norm = solver_.norm_of_right_side();
  const auto solve = [&] {
    bodies_.find_cells(world, grid_, cut_);
    const auto solved = solver_.solve(grid_.impulse, ProjectionNumbers::tolerance, norm,
                                      ProjectionNumbers::most_iterations, bodies_.any() ? &bodies_ : nullptr);
    solver_.lift_pockets(grid_.impulse);
    return solved.iterations;
  };
  pressure_iterations_ = solve();
  // Once is enough.
  if (let_go_of_walls(grid_, solver_.matrix().rows, leaving) == 0) return;
  parallel_for(grid_.impulse.size(), 1 << 14, [&](std::size_t c) {
    if (!(grid_.depth[c] > R(0))) grid_.impulse[c] = R(0);
  });
  set_up_matrix();
  pressure_iterations_ += solve();
}

template <class R>
void Projection<R>::solve_density(double dx, double dt) {
  fill_density_source(grid_, solver_.matrix());
  solver_.balance_pockets();
  const double norm = solver_.norm_of_right_side();
  density_iterations_ = solver_
                            .solve(grid_.displacement, ProjectionNumbers::density_tolerance, norm,
                                   ProjectionNumbers::most_density_iterations)
                            .iterations;
  find_moving_velocities(grid_, dx, dt);
}

template <class R>
void Projection<R>::move_bodies(World<R>& world, double dt, BodyContacts* contacts) {
  if (!bodies_.any()) return;
  bodies_.move_bodies(world, grid_.impulse, 1);
  if (contacts) {
    std::vector<Twist> before;
    for (const RigidBody& body : world.rigid) {
      Twist& twist = at_start_[body.collider].twist;
      before.push_back(std::exchange(twist, world.colliders[body.collider].twist));
    }
    contacts->resolve(at_start_, world.rigid, before, dt);
    for (const RigidBody& body : world.rigid) {
      world.colliders[body.collider].twist = at_start_[body.collider].twist;
      lock(body, world.colliders[body.collider].twist);
    }
  }
  cut_.see(world);
  cut_.find_velocities(world, grid_);
}

template <class R>
void Projection<R>::keep_pressure(World<R>& world, double scale, bool far) {
  regroup_(world, spare_, far);
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  resize_for_overwrite(world.cell_pressure, blocks.size() * block_nodes);
  parallel_for(blocks.size(), 64, [&](std::size_t b) {
    R* const pressure = world.cell_pressure.data() + b * block_nodes;
    std::fill_n(pressure, block_nodes, R(0));
    grid_.cells.for_block_rows(blocks[b], [&](std::size_t n, std::size_t at) {
      for (std::size_t k = 0; k < block_width; ++k) pressure[n + k] = grid_.impulse[at + k] * static_cast<R>(scale);
    });
  });
}

template <class R>
typename Projection<R>::Step Projection<R>::start(World<R>& world, BodyContacts* contacts) {
  Step s{};
  s.dt = world.dt_next, s.kick = 0.5 * (world.dt_before + s.dt), s.gained = world.gravity_over(s.dt) * s.kick;
  s.density = density_of(world), s.scale = s.density * world.dx / s.kick;
  s.solids = has_solids(world), s.contacts = contacts;
  s.kinetic = s.solids ? kinetic_of(world) : world.kept_kinetic_energy;
  // Impacts begin where all stood. Where bodies go is known after the pressure; others are at the
  // end of their way already.
  if (s.solids || !world.rigid.empty()) at_start_ = world.colliders;
  move_to_end(world, s.dt, false);
  free_bodies(world, s.gained, s.kick, !s.solids);
  bodies_.begin(world, s.density);
  grid_.lay(world);
  cut_.cut(world, grid_);
  return s;
}

template <class R>
ImpulseSum Projection<R>::gather(World<R>& world, const Step& s) {
  particles_to_grid(world, kernels_, grid_);
  solids_to_grid(world, grid_);
  grains_.to_grid(world, grid_);
  find_free_velocities(grid_, s.gained);
  mix_velocities(world, grid_);
  find_depths(grid_, s.dt / world.dx);
  leave_out_dry_solids(world, grid_);
  grains_.mix(world, grid_, s.kick);
  if (world.settings.damping > 0) damp(grid_, std::exp(-world.settings.damping * s.kick), s.gained);
  return apply_fields(world, grid_, s.kick);
}

template <class R>
double Projection<R>::press(World<R>& world, const Step& s) {
  take_last_pressure(world, s.scale);
  if (s.solids) lasting_ = grid_.impulse;
  if (bodies_.any()) {
    bodies_.press_on_surfaces(world, grid_, cut_, s.gained);
    cut_.see(world), cut_.find_velocities(world, grid_);
  }
  const double heat = slow_by_viscosity(world, s.kick);
  const Leaving leaving = what_lets_go(world, s.scale);
  solve_pressure(world, leaving);
  // Beside matter that takes steps of its own impacts come with these.
  move_bodies(world, s.dt, s.solids ? nullptr : s.contacts);
  apply_pressure(grid_, leaving);
  if (s.solids) {
    parallel_for(lasting_.size(), 1 << 14,
                 [&](std::size_t c) { lasting_[c] = lasting(grid_.impulse[c], lasting_[c]); });
    pushes_.assign(world.sets.size(), {});
    grains_.part(world, grid_, s.gained, lasting_, pushes_);
    solids_from_grid(world, grid_, lasting_, pushes_);
  }
  extend_velocities(grid_);
  return heat;
}

template <class R>
typename Projection<R>::Moved Projection<R>::advance(World<R>& world, const Step& s, StepSums& sums) {
  solve_density(world.dx, s.dt);
  for (const RigidBody& body : world.rigid) at_start_[body.collider].twist = world.colliders[body.collider].twist;
  move_to_end(world, s.dt, true);
  wrap_bodies(world);
  if (bodies_.any()) cut_.see(world);
  const MoveStats move = grid_to_particles(world, kernels_, grid_, cut_, s.dt, s.gained, speeds_);
  if (!move.finite)
    throw NumericalFailure(
        fmt::format("step {} at t = {:.6g} s: a particle is no longer finite; lower time.cfl (now {})", world.step,
                    world.time, world.settings.cfl));
  sums.grid.mass = mass_of(world);
  sums.pass.energy.kinetic = move.kinetic;
  const auto solids = solids_.run(world, at_start_, s.dt, s.contacts, pushes_, sums);
  keep_pressure(world, s.scale, move.far);
  sums.left_mass = sums.grid.mass - mass_of(world);
  return {move, solids};
}

template <class R>
void Projection<R>::count(World<R>& world, const Step& s, const FaceSums& faces, const Moved& moved, StepSums& sums) {
  const ParticleSet<R>* const liquid = liquid_of(world);
  const double particle = liquid ? liquid->mass : 0;
  sums.grid.max_speed = moved.liquid.fastest;
  sums.grid.kinetic = faces.energy.projected * particle, sums.grid.moment = faces.moment;
  // Energy that solids got from the liquid is not lost.
  sums.projected = faces.energy.lost * particle - sums.pass.energy.viscous +
                   (world.kept_kinetic_energy - s.kinetic - moved.solids.first - moved.solids.pushed);
  sums.transfer = s.kinetic - faces.energy.given * particle + sums.grid.kinetic - moved.liquid.kinetic;
  sums.swollen = excess_volume(grid_, solver_.matrix().rows) * world.dx * world.dx * world.dx;
  world.kept_kinetic_energy = (sums.left_mass > 0 ? kinetic_of(world) : moved.liquid.kinetic) + moved.solids.last;
  sums.body += {s.gained * sums.grid.mass, cross(sums.grid.moment, s.gained),
                -dot(world.gravity_at(world.time + s.dt) - world.gravity_at(world.time), sums.grid.moment)};
  // Faces weigh by their volume in the pressure and by their particles in the transfers, and
  // velocities beside the surface are extended: momentum is not conserved to rounding.
  sums.rounding = std::numeric_limits<double>::infinity();
  sums.pass.j_min = sums.pass.j_max = 1;
}

template <class R>
StepSums Projection<R>::step(World<R>& world, Motion<R>& motion, double next_sample_time, BodyContacts* contacts) {
  refuse_unknown(world);
  const RestOfFrame frame = rest_of_frame(world, world.dt_next);
  StepSums sums;
  sums.dt = world.dt_next, sums.limiter = world.dt_limiter, sums.frame_done = frame.done;

  const Step s = start(world, contacts);
  sums.body = gather(world, s);
  sums.pass.energy.viscous = press(world, s);
  const ParticleSet<R>* const liquid = liquid_of(world);
  const StepScale scale{liquid ? liquid->mass : 0, s.density * world.dx * world.dx * world.dx, s.gained};
  add_contact(world, grid_, cut_, viscosity_, scale, sums.grid);
  const FaceSums faces = face_sums(world, grid_, scale);
  const Moved moved = advance(world, s, sums);
  count(world, s, faces, moved, sums);

  world.node_speed = moved.liquid.fastest;
  world.dt_before = s.dt;
  const FlowSpeeds flow = s.solids ? flow_speeds(world) : FlowSpeeds{moved.liquid.usual, moved.liquid.fastest};
  choose_projection_dt(world, flow, frame.left, crowding(grid_, solver_.matrix().rows));
  advance_clock(world, s.dt, frame.done);
  world.aim_colliders();
  if (frame.done || world.time >= next_sample_time)
    take_carried_motion(world, motion), solids_.add_state(world, motion);
  return sums;
}

template class Projection<float>;
template class Projection<double>;

}  // namespace dreampm
