#include "dreampm/solver/projection/solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/physics/projection/surface.h"
#include "dreampm/solver/form_grid.h"
#include "dreampm/solver/projection/body_motion.h"
#include "dreampm/solver/projection/matter_transfers.h"
#include "dreampm/solver/step.h"
#include "dreampm/state/mechanics.h"

namespace dreampm {
namespace {

/// Explicit ones within a step: matter that wants more has lost its shape.
constexpr int most_steps = 20000;

/// The part of a cell's matter that liquid has to be, for solids there to be in it.
constexpr double least_liquid = 0.25;

/// The least mass of solids at a face that counts, over the mass of a cell of liquid.
constexpr double least_solid_mass = 1e-6;

/// Parts of a step, between which matter is pushed.
constexpr int push_parts = 4;

/// Returns the place of each id in the list.
std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& ids) {
  std::vector<std::uint32_t> place;
  for (std::size_t p = 0; p < ids.size(); ++p) {
    if (ids[p] >= place.size()) place.resize(ids[p] + std::size_t{1});
    place[ids[p]] = static_cast<std::uint32_t>(p);
  }
  return place;
}

}  // namespace

template <class R>
void solids_to_grid(const World<R>& world, MacGrid<R>& grid) {
  if (grid.solid_volume.empty()) return;
  const ParticleSet<R>* const liquid = liquid_of(world);
  const double density = liquid ? liquid->mass / liquid->rest_volume : 1;
  for (auto& f : grid.lightness) std::fill(f.begin(), f.end(), R(0));
  // For now: the volume, of which the lightness will be made.
  const GivenMatter<R> to{grid.solid_sums, grid.lightness, grid.solid_volume};
  for_blocks_by_color(world, [&](std::size_t b) {
    for (const ParticleSet<R>& set : world.sets)
      if (set.size() > 0 && is_tied(set)) give_block(world, set, b, grid.cells, {density, 1}, to);
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
void mix_velocities(const World<R>& world, MacGrid<R>& grid) {
  if (grid.solid_volume.empty()) return;
  const ParticleSet<R>* const liquid = liquid_of(world);
  const R volume = liquid ? static_cast<R>(liquid->rest_volume / (world.dx * world.dx * world.dx)) : R(0);
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t f = at.own; f < at.own + row_cells; ++f) {
        const auto [momentum, mass] = grid.solid_sums[a][f];
        const R solid_volume = grid.lightness[a][f];
        grid.lightness[a][f] = R(1);
        if (!(mass > static_cast<R>(least_solid_mass))) continue;
        const R v = grid.solid_free[a][f] = momentum / mass;
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
void leave_out_dry_solids(const World<R>& world, MacGrid<R>& grid) {
  if (std::none_of(world.sets.begin(), world.sets.end(), is_tied<R>)) return;
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
void solids_from_grid(World<R>& world, MacGrid<R>& grid, const LargeVector<R>& lasts, Pushes<R>& pushes) {
  if (grid.solid_volume.empty()) return;
  std::array<LargeVector<R>, 3> push;
  for (auto& f : push) f.assign(grid.cells.size(), R(0));
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row& row, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l, below = at.low[a] + l;
        R& change = grid.solid_free[a][f];
        const Vec3i cell = row.first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
        const bool wet = grid.depth[f] > R(0) || grid.depth[below] > R(0);
        // Walls stop dry matter in its own steps.
        if (!is_known(change) || (!wet && grid.wall_at(static_cast<int>(a), cell[static_cast<int>(a)]) >= 0)) {
          change = R(0);
          continue;
        }
        // Matter in one place has one velocity, also where there is no pressure.
        const R now = grid.velocity[a][f];
        change = (is_known(now) ? now : grid.free[a][f]) - change;
        if (wet && grid.open[a][f] > R(0))
          push[a][f] =
              -(lasts[f] - lasts[below]) * grid.lightness[a][f] * inverse_theta(grid.depth[f], grid.depth[below]);
      }
  });
  mirror_along_walls(grid, grid.solid_free), mirror_along_walls(grid, push);
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    if (is_tied(world.sets[s])) give_changes(world, world.sets[s], grid.cells, grid.solid_free, push, pushes[s]);
}

template <class R>
double kinetic_of_solids(const World<R>& world, const Motion<R>& motion) {
  double sum = 0;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    if (is_projected(set)) continue;
    const auto& m = motion.sets[s];
    sum += parallel_reduce(set.size(), 0.0, [&](double& to, std::size_t p) {
      to += kinetic_energy(set, world.dx, static_cast<Vec3d>(m.velocity[p]), static_cast<Mat3d>(m.gradient[p]));
    });
  }
  return sum;
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
  // Nothing of the last run decides the next, so that restarts are exact.
  w.left = 0, w.drift = world.drift, w.dt_next = w.kept_for = w.node_speed = 0;
  w.scatter_bounds = {};
  w.colliders = colliders;
  // Velocities of bodies are those in the middle of a step.
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
  w.sets.clear(), motion_.sets.clear(), sets_.clear(), ids_.clear();
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    if (is_projected(world.sets[s])) continue;
    ids_.push_back(world.sets[s].id), sets_.push_back(s);
    ParticleSet<R>& set = w.sets.emplace_back(std::move(world.sets[s]));
    set.carries_motion = false;
    take_carried_motion(set, Vec3<R>{}, motion_.sets.emplace_back());
    for (auto& column : set.own_velocity) column.clear();
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
  for (std::size_t n = 0; n < sets_.size(); ++n) {
    ParticleSet<R>& set = solids_.sets[n];
    renumber(set, solids_.particle_blocks);
    carry_motion(motion_.sets[n], Vec3<R>{}, set);
    set.carries_motion = true;
    ids_[n] = set.id;
    world.sets[sets_[n]] = std::move(set);
  }
  world.particle_blocks = blocks.all();
  world.left += solids_.left;
}

template <class R>
void SolidSteps<R>::push(const Pushes<R>& pushes, double part) {
  for (std::size_t n = 0; n < sets_.size(); ++n) {
    if (sets_[n] >= pushes.size() || pushes[sets_[n]].empty()) continue;
    const std::vector<Vec3<R>>& given = pushes[sets_[n]];
    const std::vector<std::uint32_t> place = places_of(ids_[n]);
    const std::vector<std::uint32_t>& id = solids_.sets[n].id;
    for (std::size_t p = 0; p < id.size(); ++p)
      motion_.sets[n].velocity[p] += static_cast<R>(part) * given[place[id[p]]];
  }
}

template <class R>
void SolidSteps<R>::take_out(const Pushes<R>& pushes) {
  pushed_.assign(sets_.size(), {});
  for (std::size_t n = 0; n < sets_.size(); ++n) {
    if (sets_[n] >= pushes.size() || pushes[sets_[n]].empty()) continue;
    const std::vector<Vec3<R>>& given = pushes[sets_[n]];
    const std::vector<std::uint32_t> place = places_of(ids_[n]);
    for (std::size_t p = 0; p < solids_.sets[n].id.size(); ++p) {
      const Vec3<R> v = given[place[solids_.sets[n].id[p]]];
      motion_.sets[n].velocity[p] -= v;
      pushed_[n].push_back(v);
    }
  }
}

template <class R>
double SolidSteps<R>::kinetic() const {
  return kinetic_of_solids(solids_, motion_);
}

template <class R>
typename SolidSteps<R>::Kinetic SolidSteps<R>::run(World<R>& world, const std::vector<Collider>& colliders, double dt,
                                                   BodyContacts* contacts, const Pushes<R>& pushes, StepSums& sums) {
  if (!has_solids(world)) return {};
  take(world, colliders, dt);
  Kinetic kinetic{.first = this->kinetic()};
  backend_->attach(solids_);
  sums.grid.colliders.resize(colliders.size());
  const bool pushed = std::any_of(pushes.begin(), pushes.end(), [](const std::vector<Vec3<R>>& of_set) {
    return std::any_of(of_set.begin(), of_set.end(), [](const Vec3<R>& v) { return v != Vec3<R>{}; });
  });
  const int parts = pushed ? push_parts : 1;
  const auto add = [&](double times) {
    backend_->download(solids_, motion_, MatterFields::id | MatterFields::motion);
    const double before = pushed ? this->kinetic() : 0;
    push(pushes, times / parts);
    kinetic.pushed += pushed ? this->kinetic() - before : 0;
    backend_->upload(solids_, motion_, MatterFields::motion);
  };
  int count = 0;
  for (int part = 1; part <= parts; ++part) {
    // Its frame ends with the part.
    solids_.frame = 1, solids_.settings.fps = 1 / (world.time + dt * part / parts);
    add(part == 1 ? 0.5 : 1.0);
    form_grid(solids_, *backend_, motion_, spare_);
    for (bool done = false; !done;) {
      if (++count > most_steps)
        throw NumericalFailure(
            fmt::format("step {} at t = {:.6g} s: matter in the liquid wants more than {} explicit steps within {:.3g} "
                        "s: it is too stiff, too fast or strained too far",
                        world.step, world.time, most_steps, dt));
      const StepSums step =
          dreampm::step(solids_, *backend_, &motion_, std::numeric_limits<double>::infinity(), contacts);
      done = step.frame_done;
      for (std::size_t w = 0; w < 6; ++w) sums.grid.walls[w] += step.grid.walls[w];
      for (std::size_t c = 0; c < colliders.size(); ++c) sums.grid.colliders[c] += step.grid.colliders[c];
      sums.pass.energy.plastic += step.pass.energy.plastic;
      if (done && part == parts) sums.pass.energy.kinetic += step.pass.energy.kinetic;
    }
  }
  add(0.5);
  for (const RigidBody& body : world.rigid) {
    Collider &to = world.colliders[body.collider], &from = solids_.colliders[body.collider];
    to.pose = from.pose, to.surface_pose = from.surface_pose, to.twist = from.twist;
    to.twist.velocity -= static_cast<Vec3d>(gained_);
    lock(body, to.twist);
  }
  kinetic.last = this->kinetic();
  // All, so that the backend has nothing left for who asks it for the whole world.
  backend_->download(solids_, motion_, MatterFields::all);
  take_out(pushes);
  give_back(world);
  return kinetic;
}

template <class R>
void SolidSteps<R>::add_state(const World<R>& world, Motion<R>& motion) {
  for (std::size_t n = 0; n < sets_.size() && n < ids_.size(); ++n) {
    const ParticleSet<R>& set = world.sets[sets_[n]];
    const std::vector<std::uint32_t> place = places_of(ids_[n]);
    auto& m = motion.sets[sets_[n]];
    for (std::size_t p = 0; p < set.size(); ++p) {
      const std::uint32_t at = place[set.id[p]];
      m.energy[p] = motion_.sets[n].energy[at];
      m.volume_ratio[p] = motion_.sets[n].volume_ratio[at];
      if (!pushed_[n].empty()) m.velocity[p] += pushed_[n][at];
    }
  }
  remember(world, motion);
}

template <class R>
void SolidSteps<R>::remember(const World<R>& world, const Motion<R>& motion) {
  shown_.assign(world.sets.size(), {});
  for (std::size_t s = 0; s < world.sets.size() && s < motion.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    if (is_projected(set) || motion.sets[s].velocity.size() != set.size()) continue;
    for (std::size_t p = 0; p < set.size(); ++p) {
      if (set.id[p] >= shown_[s].size()) shown_[s].resize(set.id[p] + std::size_t{1});
      shown_[s][set.id[p]] =
          motion.sets[s].velocity[p] - Vec3<R>{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]};
    }
  }
}

template <class R>
void SolidSteps<R>::add_shown(const World<R>& world, R sign, Motion<R>& motion) const {
  for (std::size_t s = 0; s < world.sets.size() && s < shown_.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    for (std::size_t p = 0; p < set.size(); ++p)
      if (set.id[p] < shown_[s].size()) motion.sets[s].velocity[p] += sign * shown_[s][set.id[p]];
  }
}

#define DM_INSTANTIATE(R)                                                                    \
  template void solids_to_grid(const World<R>&, MacGrid<R>&);                                \
  template void mix_velocities(const World<R>&, MacGrid<R>&);                                \
  template void leave_out_dry_solids(const World<R>&, MacGrid<R>&);                          \
  template void solids_from_grid(World<R>&, MacGrid<R>&, const LargeVector<R>&, Pushes<R>&); \
  template double kinetic_of_solids(const World<R>&, const Motion<R>&);                      \
  template class SolidSteps<R>;
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
