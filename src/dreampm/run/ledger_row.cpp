#include "dreampm/run/ledger_row.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/physics/dt.h"
#include "dreampm/state/volume_relaxation.h"

namespace dreampm {
namespace {

double mechanical(const LedgerRow& row) { return row.kinetic + row.elastic + row.gravity; }

/// The share of the energy that moves and that changes its kind which may be missed by the terms
/// below over a row: steps change their length, and matter is not linear. Chosen, not derived.
constexpr double step_share = 0.05;

/// Returns the bound of the energy of this row that may come from nowhere [J]. `momentum`: the
/// row's momentum_bound; `ulp`: the relative rounding error of one sum.
///  - A symplectic step keeps E - dt/2 P for linear matter and constant gravity, and not the energy E; P = dE/dt is the
///    power of what is stored. Only steps that a scene may ask for count: longer ones explain no more.
///  - Where matter flows plastically, the strain on trial holds energy that stress, as it was before the step, did not
///    give. The projection gives all of it up at once, so that it is at most what counts as dissipated there. Of snow
///    and seed that column is less by what hardening adds to the same strain, which is at most what is stored.
///  - Rounding: of psi, a difference of numbers as large as rho c^2, at both ends; and of momentum, at the speed that
///    matter has.
template <class R>
double energy_bound(const World<R>& world, const LedgerRow& row, const LedgerRow* before, double momentum, double ulp) {
  if (!before) return 0;
  // Matter that leaves takes its energy along, and that of place jumps where an axis comes round.
  bool counted = row.left_mass == 0;
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)]) continue;
    counted = counted && (!world.gravity_keys.empty() || world.gravity[a] == 0);
    for (const auto& key : world.gravity_keys) counted = counted && key.value[a] == 0;
  }
  if (!counted) return std::numeric_limits<double>::infinity();
  double moved = std::abs(row.work) + row.kinetic + before->kinetic;
  // Colliders that move do work on matter.
  if (std::any_of(world.colliders.begin(), world.colliders.end(), [](const Collider& c) { return c.moves(); }))
    moved += std::abs(row.dissipated_friction);
  if (!world.emitters.empty()) moved += std::abs(row.entered_energy);
  for (const auto kind : {&LedgerRow::kinetic, &LedgerRow::elastic, &LedgerRow::gravity})
    moved += std::abs(row.*kind - before->*kind);

  double dt = row.dt_max;
  if (!(world.settings.fixed_dt > 0)) dt *= std::min(1.0, largest_cfl / world.settings.cfl);
  const bool hardens = std::any_of(world.sets.begin(), world.sets.end(), [](const ParticleSet<R>& set) {
    return set.values.has("hardening") && set.values["hardening"] > 0;
  });
  const double stored = hardens ? std::max({row.elastic, before->elastic, 0.0}) : 0;
  const double swing = dt / 2 * (std::abs(row.power) + std::abs(before->power));
  const double mass = row.mass, kinetic = std::max(row.kinetic, before->kinetic);
  const double rounding = mass > 0 ? 2 * ulp * mass * world.wave_speed * world.wave_speed +
                                         momentum * (std::sqrt(2 * kinetic / mass) + momentum / (2 * mass))
                                   : 0;
  return step_share * moved + swing + std::max(row.dissipated_plasticity, 0.0) + stored + rounding;
}

/// The farthest that matter may be from the origin [m]: a box length beyond walls that are open.
template <class R>
double reach_of(const World<R>& world) {
  Vec3d far{};
  for (int a = 0; a < 3; ++a) {
    const double size = (world.high[a] - world.low[a]) * world.dx, low = world.origin[a], high = low + size;
    const auto side = static_cast<std::size_t>(2 * a);
    const bool low_open = world.walls[side].type == WallType::open,
               high_open = world.walls[side + 1].type == WallType::open;
    far[a] = std::max(std::abs(low - (low_open ? size : 0)), std::abs(high + (high_open ? size : 0)));
  }
  return length(far);
}

/// m^3: of all liquids at rest.
template <class R>
double liquid_volume(const World<R>& world) {
  double volume = 0;
  for (const auto& set : world.sets)
    if (set.liquid) volume += set.rest_volume * static_cast<double>(set.size());
  return volume;
}

/// Returns the share of their volume at rest by which liquids take more than that.
template <class R>
double swollen_share(const World<R>& world, const FrameSums& s, const LedgerRow* before) {
  const double rest = liquid_volume(world);
  if (!(rest > 0)) return 0;
  if (s.swollen) return *s.swollen / rest;
  if (before) return before->swollen;
  // Only volume relaxation measures it.
  return volume_relaxation_time(world, std::numeric_limits<double>::max()) > 0
             ? 0
             : std::numeric_limits<double>::quiet_NaN();
}

constexpr double swollen_share_warned = 0.1;

/// Cells of liquid below which a share says nothing: the nodes of one kernel are not full then, so
/// that what the density lacks at the surface is of the size of all of it.
constexpr double least_cells = 27;

}  // namespace

template <class R>
std::optional<std::string> SwollenWatch::look(const World<R>& world, const LedgerRow& row) {
  const double swollen = row.swollen, mass = row.mass, g = length(world.gravity_at(world.time));
  const double speed2 = mass > 0 ? 2 * row.kinetic / mass : 0;
  const bool known = liquid_volume(world) >= least_cells * world.dx * world.dx * world.dx;
  if (!known || !(swollen > swollen_share_warned) || !(speed2 < g * world.dx)) {
    since_.reset();
    return std::nullopt;
  }
  if (!since_) since_ = world.time;
  if (!(world.time - *since_ >= 2 * std::sqrt(world.dx / g))) return std::nullopt;
  return fmt::format(
      "{}: {:+.0f} % at frame {}, though it is calm ({:.2g} m/s, rms). A splash left gaps in it, and the surfaces of "
      "such "
      "frames hold as much too much; the column swollen of ledger.csv shows when they are gone",
      swollen_warning_start, 100 * swollen, row.frame, std::sqrt(speed2));
}

template <class R>
LedgerKind ledger_kind(const World<R>& world) {
  return {.emitters = !world.emitters.empty(), .projection = world.settings.solver == SolverKind::projection};
}

template <class R>
LedgerRow ledger_row(const World<R>& world, Backend<R>& backend, const Motion<R>& motion, const FrameSums& s,
                     const LedgerRow* before) {
  const Balance b = backend.balance(world, motion);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  LedgerRow row;
  row.frame = world.frame, row.time = world.time, row.limiter = s.limiter;
  row.substeps = static_cast<double>(s.substeps), row.stages = static_cast<double>(s.stages);
  row.dt_min = s.substeps ? s.dt_min : 0, row.dt_max = s.dt_max;
  row.particles = static_cast<double>(world.particles()), row.left = static_cast<double>(world.left);
  row.mass = b.mass, row.left_mass = s.left_mass, row.grid_mass = s.substeps ? s.grid_mass : b.mass;
  row.momentum = b.momentum, row.angular = b.angular;
  row.kinetic = b.kinetic, row.elastic = b.elastic, row.gravity = b.gravity;
  row.work = s.body.work;
  row.power = backend.stress_power(world, motion) - dot(world.gravity_at(world.time), b.momentum);
  row.dissipated_viscosity = s.lost.viscous, row.dissipated_plasticity = s.lost.plastic;
  row.dissipated_relaxation = s.lost.relaxed, row.dissipated_friction = -s.contact.work;
  row.dissipated_transfer = s.transfer, row.dissipated_damping = s.damping;
  row.wall_impulse = s.contact.impulse, row.wall_angular = s.contact.angular;
  row.body_impulse = s.body.impulse, row.body_angular = s.body.angular;
  row.left_momentum = s.left.impulse, row.left_angular = s.left.angular;
  row.volume = b.volume, row.swollen = swollen_share(world, s, before);
  row.j_min = world.particles() > 0 ? b.j_min : unknown, row.j_max = world.particles() > 0 ? b.j_max : unknown;
  if (!world.emitters.empty()) {
    row.entered = static_cast<double>(s.entered.particles);
    row.entered_mass = s.entered.mass, row.entered_energy = s.entered.energy;
    row.entered_momentum = s.entered.momentum, row.entered_angular = s.entered.angular;
  }
  if (world.settings.solver == SolverKind::projection) {
    row.dissipated_projection = s.projected.value_or(0);
    row.volume += s.swollen.value_or(0);
  }

  const double lost = before ? mechanical(*before) + s.body.work + s.entered.energy - mechanical(row) : 0;
  row.dissipated = lost;
  row.dissipated_rest = lost - s.lost.viscous - s.lost.plastic - s.lost.relaxed + s.contact.work - s.transfer -
                        s.damping - s.projected.value_or(0);

  // Stresses give nothing in sum, but are rounded: sum m |tau|/(rho c) is at most sqrt(2 M psi). A
  // law's psi is a difference of numbers as large as its modulus rho c^2, and rounded as these are:
  // the sum may be off by an ulp of M c^2, and below 0.
  const double ulp = roundings * static_cast<double>(std::numeric_limits<R>::epsilon());
  const double measured = std::max({b.elastic, before ? before->elastic : 0, 0.0});
  const double stored = measured + ulp * b.mass * world.wave_speed * world.wave_speed;
  const double stresses = ulp * static_cast<double>(s.substeps) * std::sqrt(2 * b.mass * stored);
  const double bound = s.rounding + stresses;
  row.momentum_bound = bound;
  row.energy_bound = energy_bound(world, row, before, bound, ulp);
  // Matter that leaves one end of a periodic axis and comes back at the other turns about another
  // point. Of the transfers only APIC keeps angular momentum (docs/howto/transfers.md).
  const bool turns = std::none_of(world.periodic.begin(), world.periodic.end(), [](bool p) { return p; }) &&
                     std::all_of(world.sets.begin(), world.sets.end(), [](const ParticleSet<R>& set) {
                       return set.transfer.affine == 1 && !set.transfer.keeps_velocity();
                     });
  row.angular_bound = turns ? bound * reach_of(world) + s.jumps : std::numeric_limits<double>::infinity();
  return row;
}

template std::optional<std::string> SwollenWatch::look(const World<float>&, const LedgerRow&);
template std::optional<std::string> SwollenWatch::look(const World<double>&, const LedgerRow&);
template LedgerKind ledger_kind(const World<float>&);
template LedgerKind ledger_kind(const World<double>&);
template LedgerRow ledger_row(const World<float>&, Backend<float>&, const Motion<float>&, const FrameSums&,
                              const LedgerRow*);
template LedgerRow ledger_row(const World<double>&, Backend<double>&, const Motion<double>&, const FrameSums&,
                              const LedgerRow*);

}  // namespace dreampm
