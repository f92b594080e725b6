#include "dreampm/solver/step_accounting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dreampm/state/mechanics.h"
#include "dreampm/state/volume_relaxation.h"

namespace dreampm {
namespace {

/// Adds up the matter that all sinks took so far.
template <class R>
void add_taken(const World<R>& world, std::uint64_t& taken, ImpulseSum& took_along) {
  for (const Sink& sink : world.sinks) {
    taken += sink.taken;
    took_along.impulse += sink.momentum;
    took_along.angular += sink.angular;
  }
}

}  // namespace

template <class R>
StepAccounting<R>::StepAccounting(const World<R>& world, Backend<R>& backend, bool frame_done)
    : world_(world), backend_(backend), mass_(mass_of(world)) {
  sums_.dt = world.dt_next;
  sums_.limiter = world.dt_limiter;
  sums_.stages = world.viscous_stages;
  sums_.frame_done = frame_done;
}

template <class R>
void StepAccounting<R>::grid_updated(const GridStats& grid) {
  const Vec3d kick = world_.gravity_over(sums_.dt) * sums_.dt;
  sums_.body = grid.damping;
  sums_.body.work = 0;
  sums_.body += grid.fields;
  sums_.body += {kick * mass_, cross(grid.moment, kick), 0};
  sums_.body.work -= dot(world_.gravity_at(world_.time + sums_.dt) - world_.gravity_at(world_.time), grid.moment);
  // A few roundings of all that moves. The sum of m |v| is at most sqrt(2 M K) (Cauchy-Schwarz).
  sums_.rounding = roundings * static_cast<double>(std::numeric_limits<R>::epsilon()) *
                   (std::sqrt(2 * mass_ * grid.kinetic) + mass_ * length(kick));
}

template <class R>
void StepAccounting<R>::sub_cycled(double heat) {
  heat_ = heat;
  sums_.rounding *= 1 + sums_.stages;
}

template <class R>
void StepAccounting<R>::before_sort() {
  // The walls of periodic axes are open, and nothing leaves there.
  bool may_leave = false;
  for (std::size_t side = 0; side < 6; ++side)
    may_leave = may_leave || (world_.walls[side].type == WallType::open && !world_.periodic[side / 2]);
  if (!may_leave && world_.sinks.empty()) return;
  before_sort_ = {may_leave ? backend_.grid_momentum(world_, NodesHold::velocities) : ImpulseSum{}, world_.left, 0, {}};
  add_taken(world_, before_sort_->taken, before_sort_->took_along);
}

template <class R>
void StepAccounting<R>::add_what_left() {
  if (!before_sort_ || before_sort_->left == world_.left) return;
  sums_.left_mass = mass_ - mass_of(world_);
  // Sinks report the matter that they took. The grid does not show it beside walls, whose images
  // are on it.
  std::uint64_t taken = 0;
  ImpulseSum took_along;
  add_taken(world_, taken, took_along);
  if (world_.left - before_sort_->left == taken - before_sort_->taken) {
    sums_.left.impulse = took_along.impulse - before_sort_->took_along.impulse;
    sums_.left.angular = took_along.angular - before_sort_->took_along.angular;
    return;
  }
  // Stresses give nothing in sum: what the grid lacks now is what left.
  const ImpulseSum now = backend_.grid_momentum(world_, NodesHold::momenta);
  sums_.left.impulse = before_sort_->on_grid.impulse - now.impulse;
  sums_.left.angular = before_sort_->on_grid.angular - now.angular;
}

template <class R>
StepSums StepAccounting<R>::transferred(GridStats grid, const PassStats& pass) {
  sums_.grid = std::move(grid);
  sums_.pass = pass;
  add_what_left();
  // A kept velocity is not the grid's: what the grid cannot see of it comes back in the gather, and
  // counts both ways. What left is missing in the pass.
  if (sums_.left_mass == 0)
    sums_.transfer = world_.kept_kinetic_energy - sums_.grid.arrived + sums_.grid.kinetic - pass.energy.kinetic;
  sums_.pass.energy.viscous += heat_;
  // Shifts of liquids are part of their volume relaxation; displacements out of colliders count
  // with it.
  sums_.body.angular += pass.turned;
  sums_.pass.energy.relaxed += dot(world_.gravity_at(world_.time + sums_.dt), pass.shifted);
  if (volume_relaxation_time(world_, sums_.dt) > 0) sums_.swollen = pass.swollen;
  return std::move(sums_);
}

template class StepAccounting<float>;
template class StepAccounting<double>;

}  // namespace dreampm
