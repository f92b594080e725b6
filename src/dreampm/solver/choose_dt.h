// How long the next step is: the bounds of physics/dt.h for what a world holds, and the split of
// its frame into steps.
#pragma once
#include "dreampm/state/world.h"

namespace dreampm {

/// s: the time at which the world's frame ends.
template <class R>
double frame_end(const World<R>& world);

/// The rest of a frame after a step.
struct RestOfFrame {
  bool done;    ///< true if the step ends the frame
  double left;  ///< s: from the end of the step to that of the frame, or of the next frame where the step ends one
};
/// Returns the rest of the frame after a step of `dt` [s] from now.
template <class R>
RestOfFrame rest_of_frame(const World<R>& world, double dt);

/// Sets world.dt_next and its limiter: steps as long as `bound` allows, and short enough that equal
/// ones fill what is `left` of the frame [s].
template <class R>
void split_frame(World<R>& world, const StepBound& bound, double left);

/// Advances the clock by a step of `dt` [s]: counts and time.
template <class R>
void advance_clock(World<R>& world, double dt, bool frame_done);

/// Chooses world.dt_next with its limiter and its stages of viscosity: as long as the bounds allow,
/// and short enough that equal steps fill what is `left` of the frame [s] when that step begins.
/// `node_speed` [m/s]: of the fastest node now.
template <class R>
void choose_dt(World<R>& world, double node_speed, double left);

/// s: how long a step of a fixed dt may be where nodes move at up to `node_speed` [m/s]: what the
/// largest cfl of scenes allows. Viscosity does not count where it is sub-cycled.
template <class R>
double longest_stable_dt(const World<R>& world, double node_speed);

/// True if the coming step, as chosen, is stable for matter at `speed` [m/s] too, at the largest
/// cfl of scenes.
template <class R>
bool step_suits(const World<R>& world, double speed);

}  // namespace dreampm
