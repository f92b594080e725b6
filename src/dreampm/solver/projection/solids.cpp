#include "dreampm/solver/projection/solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/solver/form_grid.h"
#include "dreampm/solver/projection/block_window.h"
#include "dreampm/solver/projection/body_motion.h"
#include "dreampm/solver/step.h"

namespace dreampm {
namespace {

/// Explicit ones of elastic matter within a step: what wants more has lost its shape.
constexpr int most_steps = 20000;

/// The part of a cell's matter that liquid has to be, for solids there to be in it.
constexpr double least_liquid = 0.25;

/// Where solids are at all on a face, over the mass of a cell of liquid.
constexpr double least_solid_mass = 1e-6;

template <class R>
void give_solid_block(const World<R>& world, const ParticleSet<R>& set, double density, std::size_t b,
                      MacGrid<R>& grid) {
  const Window<0> window(grid.cells, world.particle_blocks[b]);
  const double cell = world.dx * world.dx * world.dx;
  const R dx = static_cast<R>(world.dx), mass = static_cast<R>(set.mass / (density * cell)),
          volume = static_cast<R>(set.rest_volume / cell);
  for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
    const StaggeredPlace<R> place(Four<R>{set.u[0][p], set.u[1][p], set.u[2][p], 0} + R(0.5));
    for (std::size_t a = 0; a < 3; ++a) {
      const TrilinearCell<R> cell_of_face = place.faces(static_cast<int>(a));
      Four<R> motion;
      motion_along(set, p, a, dx, motion);
      Four<R> given[4];
      given_to_faces(cell_of_face, motion, given);
      for (int n = 0; n < 4; ++n)
        for (int k = 0; k < 2; ++k) {
          const std::size_t at = window.place(cell_of_face.first[0] + (n >> 1), cell_of_face.first[1] + (n & 1),
                                              cell_of_face.first[2] + k);
          const R w = mass * given[n][2 * k + 1];
          grid.solid_sums[a][at] += {mass * given[n][2 * k], w};
          // For now: the volume, of which the lightness will be made.
          grid.lightness[a][at] += volume * given[n][2 * k + 1];
        }
    }
    const TrilinearCell<R> center = place.centers();
    const Corners<R> shares = shares_of_centers(center);
    for (int n = 0; n < 8; ++n) {
      const R share = (n < 4 ? shares.low : shares.high)[n & 3] * volume;
      grid.solid_volume[window.place(center.first[0] + (n >> 2), center.first[1] + (n >> 1 & 1),
                                     center.first[2] + (n & 1))] += share;
    }
  }
}

}  // namespace

template <class R>
void solids_to_grid(const World<R>& world, MacGrid<R>& grid) {
  if (grid.solid_volume.empty()) return;
  const ParticleSet<R>* const liquid = liquid_of(world);
  const double density = liquid ? liquid->mass / liquid->rest_volume : 1;
  for (auto& f : grid.lightness) std::fill(f.begin(), f.end(), R(0));
  for_blocks_by_color(world, [&](std::size_t b) {
    for (const ParticleSet<R>& set : world.sets)
      if (set.size() > 0 && !is_projected(set)) give_solid_block(world, set, density, b, grid);
  });
  if (grid.cells.wraps()) {
    for (std::size_t a = 0; a < 3; ++a)
      grid.cells.fold(grid.solid_sums[a].data()), grid.cells.fold(grid.lightness[a].data());
    grid.cells.fold(grid.solid_volume.data());
  }
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t c = at.own; c < at.own + row_cells; ++c) grid.density[c] += grid.solid_volume[c];
  });
}

template <class R>
void mix_velocities(const World<R>& world, MacGrid<R>& grid, const Vec3d& gained) {
  if (grid.solid_volume.empty()) return;
  const ParticleSet<R>* const liquid = liquid_of(world);
  const R volume = liquid ? static_cast<R>(liquid->rest_volume / (world.dx * world.dx * world.dx)) : R(0);
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const R gain = static_cast<R>(gained[static_cast<int>(a)]);
      for (std::size_t f = at.own; f < at.own + row_cells; ++f) {
        const auto [momentum, mass] = grid.solid_sums[a][f];
        const R solid_volume = grid.lightness[a][f];
        grid.lightness[a][f] = R(1);
        if (!(mass > static_cast<R>(least_solid_mass))) continue;
        const R v = grid.solid_free[a][f] = momentum / mass + gain;
        const R own = is_known(grid.free[a][f]) ? volume * grid.sums[a][f].weight : R(0);
        grid.free[a][f] = ((own > R(0) ? own * grid.free[a][f] : R(0)) + mass * v) / (own + mass);
        grid.lightness[a][f] = (own + solid_volume) / (own + mass);
      }
    }
  });
  for (std::size_t a = 0; a < 3; ++a) {
    grid.wrap(grid.free[a]), grid.wrap(grid.solid_free[a]), grid.wrap(grid.lightness[a]);
    grid.wrap(grid.solid_sums[a]);
  }
}

template <class R>
void leave_out_dry_solids(MacGrid<R>& grid) {
  if (grid.solid_volume.empty()) return;
  const auto in_liquid = [&](std::size_t c) {
    return grid.density[c] - grid.solid_volume[c] >= static_cast<R>(least_liquid) * grid.density[c];
  };
  // From the cells of liquid on through those of solids.
  std::vector<std::uint8_t> wet(grid.cells.size(), 0);
  std::vector<Vec3i> front;
  for (const CellRows::Row& row : grid.cells.rows())
    for (int l = 0; l < row_cells; ++l) {
      const std::size_t c = std::size_t{row.number} * row_cells + static_cast<std::size_t>(l);
      if (!(grid.depth[c] > R(0)) || !in_liquid(c)) continue;
      wet[c] = 1;
      front.push_back(row.first + Vec3i{0, 0, l});
    }
  while (!front.empty()) {
    const Vec3i cell = front.back();
    front.pop_back();
    const std::size_t c = grid.cells.place_of(cell);
    for (int a = 0; a < 3; ++a)
      for (const int way : {-1, 1}) {
        Vec3i beside = cell;
        beside[a] += way;
        const std::size_t n = grid.cells.place_of(beside);
        if (wet[n] || !(grid.depth[n] > R(0)) || !(grid.open[static_cast<std::size_t>(a)][way < 0 ? c : n] > R(0)))
          continue;
        wet[n] = 1;
        front.push_back(beside);
      }
  }
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t c = at.own; c < at.own + row_cells; ++c)
      if (grid.depth[c] > R(0) && !wet[c]) grid.depth[c] = R(-1);
  });
  grid.wrap(grid.depth);
}

template <class R>
void solids_from_grid(World<R>& world, const MacGrid<R>& grid, const Vec3d& gained) {
  if (grid.solid_volume.empty()) return;
  const auto change = [&](std::size_t a, std::size_t f) {
    if (!is_known(grid.solid_free[a][f])) return R(0);
    // Where no pressure is, matter in one place has one velocity all the same.
    const R now = grid.velocity[a][f];
    return (is_known(now) ? now : grid.free[a][f]) - grid.solid_free[a][f];
  };
  const R per_cell = static_cast<R>(1 / world.dx);
  for (ParticleSet<R>& set : world.sets) {
    if (set.size() == 0 || is_projected(set)) continue;
    parallel_for(world.particle_blocks.size(), 4, [&](std::size_t b) {
      if (set.block_start[b] == set.block_start[b + 1]) return;
      const Window<0> window(grid.cells, world.particle_blocks[b]);
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        const StaggeredPlace<R> place(Four<R>{set.u[0][p], set.u[1][p], set.u[2][p], 0} + R(0.5));
        for (std::size_t a = 0; a < 3; ++a) {
          const TrilinearCell<R> cell = place.faces(static_cast<int>(a));
          const auto corner = [&](int i, int n) {
            return change(a, window.place(cell.first[0] + i, cell.first[1] + (n >> 1), cell.first[2] + (n & 1)));
          };
          const Corners<R> corners{{corner(0, 0), corner(0, 1), corner(0, 2), corner(0, 3)},
                                   {corner(1, 0), corner(1, 1), corner(1, 2), corner(1, 3)}};
          Four<R> gain;
          trilinear_slope(cell, corners, gain);
          set.own[a][p] += static_cast<R>(gained[static_cast<int>(a)]) + gain[0];
          for (std::size_t t = 0; t < 3; ++t) set.gradient[3 * a + t][p] += gain[static_cast<int>(t) + 1] * per_cell;
        }
      }
    });
  }
}

template <class R>
void SolidSteps<R>::take(World<R>& world, const std::vector<Collider>& colliders, double dt) {
  World<R>& w = solids_;
  w.step = world.step, w.time = world.time, w.dx = world.dx;
  w.origin = world.origin, w.low = world.low, w.high = world.high;
  w.walls = world.walls, w.periodic = world.periodic;
  w.gravity = world.gravity, w.gravity_keys = world.gravity_keys;
  w.settings = world.settings;
  w.settings.solver = SolverKind::explicit_steps;
  w.settings.cfl = StepSettings{}.cfl;
  // Fields and damping have acted on faces.
  w.settings.fixed_dt = w.settings.damping = 0;
  // Its frame ends with the step.
  w.frame = 1, w.settings.fps = 1 / (world.time + dt);
  // Nothing of the last run decides the next, so that restarts are exact.
  w.left = 0, w.drift = world.drift, w.dt_next = w.kept_for = 0;
  w.colliders = colliders;
  // Velocities of a projection are those in the middle of a step.
  gained_ = static_cast<Vec3<R>>(world.gravity_over(dt) * (0.5 * dt));
  // Springs have acted on bodies.
  w.rigid = world.rigid, w.collision = world.collision;
  for (RigidBody& body : w.rigid) {
    body.spring.reset(), body.hold.reset();
    Twist& twist = w.colliders[body.collider].twist;
    twist.velocity -= static_cast<Vec3d>(gained_);
    lock(body, twist);
  }
  w.particle_blocks = world.particle_blocks;
  w.sets.clear(), motion_.sets.clear(), sets_.clear();
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    if (is_projected(world.sets[s])) continue;
    sets_.push_back(s);
    ParticleSet<R>& set = w.sets.emplace_back(std::move(world.sets[s]));
    set.carries_motion = false;
    take_carried_motion(set, gained_, motion_.sets.emplace_back());
    for (auto& column : set.own) column.clear();
    for (auto& column : set.gradient) column.clear();
  }
}

template <class R>
void SolidSteps<R>::give_back(World<R>& world) {
  BlockList blocks;
  std::vector<Vec3i> all = world.particle_blocks;
  all.insert(all.end(), solids_.particle_blocks.begin(), solids_.particle_blocks.end());
  blocks.assign(std::move(all));
  const auto renumber = [&](ParticleSet<R>& set, const std::vector<Vec3i>& of) {
    std::vector<std::uint32_t> start(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < of.size() && !set.block_start.empty(); ++b)
      start[static_cast<std::size_t>(blocks.find(of[b])) + 1] = set.block_start[b + 1] - set.block_start[b];
    for (std::size_t b = 0; b < blocks.size(); ++b) start[b + 1] += start[b];
    set.block_start = std::move(start);
  };
  for (ParticleSet<R>& set : world.sets)
    if (is_projected(set)) renumber(set, world.particle_blocks);
  ids_.resize(sets_.size());
  for (std::size_t n = 0; n < sets_.size(); ++n) {
    ParticleSet<R>& set = solids_.sets[n];
    renumber(set, solids_.particle_blocks);
    carry_motion(motion_.sets[n], gained_, set);
    set.carries_motion = true;
    ids_[n] = set.id;
    world.sets[sets_[n]] = std::move(set);
  }
  world.particle_blocks = blocks.all();
  world.left += solids_.left;
}

template <class R>
void SolidSteps<R>::run(World<R>& world, const std::vector<Collider>& colliders, double dt, BodyContacts* contacts,
                        StepSums& sums) {
  if (!has_solids(world)) return;
  take(world, colliders, dt);
  backend_->attach(solids_);
  form_grid(solids_, *backend_, motion_);
  sums.grid.colliders.resize(colliders.size());
  int count = 0;
  for (bool done = false; !done;) {
    if (++count > most_steps)
      throw NumericalFailure(
          fmt::format("step {} at t = {:.6g} s: elastic matter wants more than {} steps within {:.3g} s: it is too "
                      "stiff, too fast or strained too far",
                      world.step, world.time, most_steps, dt));
    const StepSums step =
        dreampm::step(solids_, *backend_, &motion_, std::numeric_limits<double>::infinity(), contacts);
    done = step.frame_done;
    for (std::size_t w = 0; w < 6; ++w) sums.grid.walls[w] += step.grid.walls[w];
    for (std::size_t c = 0; c < colliders.size(); ++c) sums.grid.colliders[c] += step.grid.colliders[c];
    sums.pass.energy.plastic += step.pass.energy.plastic;
    if (done) sums.pass.energy.kinetic += step.pass.energy.kinetic;
  }
  for (const RigidBody& body : world.rigid) {
    Collider &to = world.colliders[body.collider], &from = solids_.colliders[body.collider];
    to.pose = from.pose, to.surface_pose = from.surface_pose, to.twist = from.twist;
    to.twist.velocity -= static_cast<Vec3d>(gained_);
    lock(body, to.twist);
  }
  give_back(world);
}

template <class R>
void SolidSteps<R>::add_state(const World<R>& world, Motion<R>& motion) const {
  for (std::size_t n = 0; n < sets_.size() && n < ids_.size(); ++n) {
    const ParticleSet<R>& set = world.sets[sets_[n]];
    std::vector<std::uint32_t> place;
    for (std::size_t p = 0; p < ids_[n].size(); ++p) {
      if (ids_[n][p] >= place.size()) place.resize(ids_[n][p] + std::size_t{1});
      place[ids_[n][p]] = static_cast<std::uint32_t>(p);
    }
    auto& m = motion.sets[sets_[n]];
    for (std::size_t p = 0; p < set.size(); ++p) {
      m.energy[p] = motion_.sets[n].energy[place[set.id[p]]];
      m.volume_ratio[p] = motion_.sets[n].volume_ratio[place[set.id[p]]];
    }
  }
}

#define DM_INSTANTIATE(R)                                                     \
  template void solids_to_grid(const World<R>&, MacGrid<R>&);                 \
  template void mix_velocities(const World<R>&, MacGrid<R>&, const Vec3d&);   \
  template void leave_out_dry_solids(MacGrid<R>&);                            \
  template void solids_from_grid(World<R>&, const MacGrid<R>&, const Vec3d&); \
  template class SolidSteps<R>;
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
