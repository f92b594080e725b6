// Sums over the particles and nodes of host memory: what the ledger writes. A Backend offers them
// as its reductions, and one that keeps its matter elsewhere replaces them.
#pragma once
#include "dreampm/backend/impulse_sum.h"
#include "dreampm/backend/motion.h"
#include "dreampm/state/mechanics.h"

namespace dreampm {

/// The sums of mechanics over a world.
struct Balance {
  double mass = 0;                               ///< kg
  Vec3d momentum{};                              ///< kg m/s
  Vec3d angular{};                               ///< kg m^2/s about the origin, with the affine part
  double kinetic = 0, elastic = 0, gravity = 0;  ///< J; gravity: -m g . x with the g of this moment, so that a
                                                 ///< changing g does work: its change is -m (dg/dt . x) by itself
  double volume = 0;                             ///< m^3: sum V0 J
  double j_min = 1e30, j_max = -1e30;
};

/// `motion` must be of the world's last pass.
template <class R>
Balance balance(const World<R>& world, const Motion<R>& motion);

/// The rate at which stress stores elastic energy [W]: sum V0 tau : grad v. `motion` must be of the
/// world's last pass.
template <class R>
double stress_power(const World<R>& world, const Motion<R>& motion);

/// The content of nodes: momenta between steps, velocities after grid_update.
enum class NodesHold { momenta, velocities };

/// The momentum and angular momentum of all nodes; no work.
template <class R>
ImpulseSum grid_momentum(const World<R>& world, NodesHold hold);

}  // namespace dreampm
