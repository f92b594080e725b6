// Elastic matter, snow and pastes in the liquid of a projection. The pressure acts on both: where
// they meet they have one velocity, and a face weighs what lies there (variable density, as in
// Bridson 2015, chapter 5). Between two steps the solids go on by explicit steps of their own, from
// the velocities that the pressure gave them; sand (grains.h) with them.
#pragma once
#include "dreampm/backend/backend.h"
#include "dreampm/rigid/rigid_motion.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/matter_transfers.h"
#include "dreampm/solver/step_accounting.h"

namespace dreampm {

/// True if any matter goes by explicit steps.
template <class R>
bool has_solids(const World<R>& world) {
  return !std::all_of(world.sets.begin(), world.sets.end(), is_projected<R>);
}

/// Adds the density of the solids, and their momentum to the free velocities, that are there; after
/// particles_to_grid.
template <class R>
void solids_to_grid(const World<R>& world, MacGrid<R>& grid);
template <class R>
void mix_velocities(const World<R>& world, MacGrid<R>& grid);

/// Turns cells of solids into air unless liquid touches them, or solids that it touches: no
/// pressure acts in them; after find_depths.
template <class R>
void leave_out_dry_solids(const World<R>& world, MacGrid<R>& grid);

/// Gives the solids' particles the change of their velocity and its slope by pressure and liquid,
/// and `pushes`; after apply_pressure. `lasts`: of cells, the lasting part of the pressure.
/// `solid_free` becomes the change.
template <class R>
void solids_from_grid(World<R>& world, MacGrid<R>& grid, const LargeVector<R>& lasts, Pushes<R>& pushes);

/// J, of matter that goes by explicit steps.
template <class R>
double kinetic_of_solids(const World<R>& world, const Motion<R>& motion);

/// The explicit steps of the solids of a world.
template <class R>
class SolidSteps {
 public:
  struct Kinetic {
    double first = 0, last = 0, pushed = 0;  ///< J; what pushes gave
  };
  explicit SolidSteps(Backend<R>* backend) : backend_(backend) {}
  /// Takes the solids of `world` from its time on for `dt` [s], among `colliders` as they stand
  /// then, whose twists are those of the step; rigid bodies with them. Their order, and the blocks
  /// of particles of the world, change: a regroup has to follow. Throws NumericalFailure. Adds what
  /// walls and colliders gave to `sums`, and what bodies got to their twists.
  /// Returns their energies of motion.
  Kinetic run(World<R>& world, const std::vector<Collider>& colliders, double dt, BodyContacts* contacts,
              const Pushes<R>& pushes, StepSums& sums);
  /// Adds the results of the last run: energies and volume ratios of its particles by their ids,
  /// and velocities as they are: those that particles carry have their push taken out.
  void add_state(const World<R>& world, Motion<R>& motion);
  /// `motion` shows velocities as they are: remembers how far they are from those that particles
  /// carry.
  void remember(const World<R>& world, const Motion<R>& motion);
  /// Adds the difference between velocities that particles carry and those as they are; `sign` -1:
  /// subtracts it.
  void add_shown(const World<R>& world, R sign, Motion<R>& motion) const;

 private:
  void take(World<R>& world, const std::vector<Collider>& colliders, double dt);
  void give_back(World<R>& world);
  double kinetic() const;
  /// Adds a part of the pushes to the motion.
  void push(const Pushes<R>& pushes, double part);
  void take_out(const Pushes<R>& pushes);

  Backend<R>* backend_;  ///< null where there are no solids
  World<R> solids_;
  Motion<R> motion_, spare_;                     ///< spare_: memory of form_grid
  Vec3<R> gained_;                               ///< m/s, by gravity in half of the step
  std::vector<std::size_t> sets_;                ///< of the world, in their order here
  Pushes<R> pushed_;                             ///< in the order in which they were given back
  Pushes<R> shown_;                              ///< by sets of the world and ids
  std::vector<std::vector<std::uint32_t>> ids_;  ///< as they were taken, then as they were given back
};

}  // namespace dreampm
