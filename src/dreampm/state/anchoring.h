// When liquids are anchored: J drawn to the measured density (physics/materials/newtonian.h) and particles shifted
// (physics/shift.h). Not in every step: it takes hundreds of cells of sound, and measuring costs.
#pragma once
#include "dreampm/state/world.h"

namespace dreampm {

/// Cells that sound (or the pace of the anchoring, where that is faster) crosses from one anchoring to the next.
inline constexpr double anchoring_stride = 4;

/// The time [s] since liquids were anchored last, if they are in a step of `dt` [s] from now; 0 if they are not. It
/// hangs on the world's time alone, so that a run which goes on from a checkpoint keeps it.
template <class R>
double anchoring_time(const World<R>& world, double dt);

}  // namespace dreampm
