// When the volume of liquids is relaxed: J towards the measured density
// (physics/materials/newtonian.h), and particles shifted (physics/shift.h). Not in every step: it
// takes hundreds of cells of sound, and measuring costs.
#pragma once
#include "dreampm/state/world.h"

namespace dreampm {

/// The time [s] since the last volume relaxation, if they are in a step of `dt` [s] from now; 0 if
/// they are not. It depends on the world's time alone, so that a run which goes on from a
/// checkpoint keeps it.
template <class R>
double volume_relaxation_time(const World<R>& world, double dt);

}  // namespace dreampm
