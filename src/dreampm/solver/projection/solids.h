// Elastic matter in the liquid of a projection. The pressure acts on both: where they meet they
// have one velocity, and a face weighs what lies there (variable density, as in Bridson 2015,
// chapter 5). Between two steps the solids go on by explicit steps of their own, from the
// velocities that the pressure gave them.
#pragma once
#include "dreampm/backend/backend.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/rigid_motion.h"
#include "dreampm/solver/step_accounting.h"

namespace dreampm {

/// Whether any matter goes by explicit steps.
template <class R>
bool has_solids(const World<R>& world) {
  return !std::all_of(world.sets.begin(), world.sets.end(), is_projected<R>);
}

/// After particles_to_grid: adds what the solids are to the density, and their momentum to the
/// free velocities, that are there, `gained` [m/s] later.
template <class R>
void solids_to_grid(const World<R>& world, MacGrid<R>& grid);
template <class R>
void mix_velocities(const World<R>& world, MacGrid<R>& grid, const Vec3d& gained);

/// After find_depths: solids that liquid does not touch, nor solids that it touches, are none of
/// the pressure's: their cells become air.
template <class R>
void leave_out_dry_solids(MacGrid<R>& grid);

/// After apply_pressure: the solids' particles are `gained` [m/s] later, too, and get what the
/// pressure and the liquid changed of their velocity and its slope.
template <class R>
void solids_from_grid(World<R>& world, const MacGrid<R>& grid, const Vec3d& gained);

/// The explicit steps of the solids of a world.
template <class R>
class SolidSteps {
 public:
  explicit SolidSteps(Backend<R>* backend) : backend_(backend) {}
  /// Takes the solids of `world` from its time on for `dt` [s], among `colliders` as they stand
  /// then, whose twists are those of the step; rigid bodies with them. Their order, and the blocks
  /// of particles of the world, change: a regroup has to follow. Throws NumericalFailure. Adds what
  /// walls and colliders gave to `sums`, and what bodies got to their twists.
  void run(World<R>& world, const std::vector<Collider>& colliders, double dt, BodyContacts* contacts, StepSums& sums);
  /// Of the last run: energies and volume ratios of its particles by their ids.
  void add_state(const World<R>& world, Motion<R>& motion) const;

 private:
  void take(World<R>& world, const std::vector<Collider>& colliders, double dt);
  void give_back(World<R>& world);

  Backend<R>* backend_;  ///< null where there are no solids
  World<R> solids_;
  Motion<R> motion_;
  Vec3<R> gained_;                 ///< m/s, by gravity in half of the step
  std::vector<std::size_t> sets_;  ///< of the world, in their order here
  std::vector<std::vector<std::uint32_t>> ids_;
};

}  // namespace dreampm
