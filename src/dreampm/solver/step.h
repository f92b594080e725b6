// THE step, and its beginning.
#pragma once
#include <limits>
#include <optional>
#include <span>

#include "dreampm/backend/backend.h"
#include "dreampm/base/error.h"

namespace dreampm {

struct StepSums {
  double dt = 0;  ///< s, taken
  Limiter limiter = Limiter::user;
  int stages = 0;  ///< of viscosity; 0: explicit
  GridStats grid;
  PassStats pass;
  ImpulseSum body;       ///< what matter received from gravity, damping and fields; work: of fields, and of a
                         ///< gravity that changes on what is potential energy
  ImpulseSum left;       ///< what left through open walls took along, without its energy
  double left_mass = 0;  ///< kg
  double transfer = 0;   ///< J of kinetic energy that the grid did not give to the particles; of sets that keep
                         ///< velocities also what the particles did not give to the grid. 0 where some left
  /// m^3: volume that liquids take beyond that at rest; only of steps that relax the volume of liquids.
  std::optional<double> swollen;
  double rounding = 0;      ///< N s that rounding may have lost or gained, apart from that of stresses
  bool frame_done = false;  ///< world.frame was increased: time is the new frame's
};

/// Units in the last place of all that moves by which the sums of a step may be off: gather, move, law, scatter and
/// grid each round, but to both sides.
inline constexpr double roundings = 1;

/// Brings the first matter into an empty world, seeds[s] into set s, and chooses the first step. The backend keeps
/// nothing of a world that it ran before. Ids must be unique within the world. Throws NumericalFailure.
template <class R>
void begin(World<R>& world, Backend<R>& backend, const std::vector<std::vector<ParticleSeed>>& seeds);

/// s: how long steps of a fixed dt may be after `begin` with these seeds: what the largest cfl of scenes allows.
/// Viscosity does not count where it is sub-cycled.
template <class R>
double longest_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds);

/// One step of world.dt_next:  grid_update -> choose the next dt -> sort if due -> g2p2g -> report.
/// `motion` is filled, if not null, in the pass that ends a frame and in one that ends at `next_sample_time` [s] or
/// later. Throws NumericalFailure; the world is then lost.
template <class R>
StepSums step(World<R>& world, Backend<R>& backend, Motion<R>* motion,
              double next_sample_time = std::numeric_limits<double>::infinity());

/// After an edit of a world's particles, laws, walls or gravity: sorts the particles, chooses the next step anew, and
/// forms the grid from them as they stand, with the forces of the laws as they are. Nothing of the former grid is left.
/// `motion`: velocities in the particles' order; returned in the order after the sort. Throws NumericalFailure.
template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion);

}  // namespace dreampm
