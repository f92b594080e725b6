// How long the next step of the projection is.
#pragma once
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Sets World::dt_next, from how fast matter is, of the `left` [s] of the frame. `crowding`: the
/// part of the liquid's volume that is too much (step_sums.h).
template <class R>
void choose_projection_dt(World<R>& world, FlowSpeeds flow, double left, double crowding = 0);

}  // namespace dreampm
