// Force fields on the faces of a step of the projection, before its pressure.
#pragma once
#include "dreampm/backend/impulse_sum.h"
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// The fields of a world change the free velocities for `kick` [s], as gravity does. Returns what
/// they gave.
template <class R>
ImpulseSum apply_fields(const World<R>& world, MacGrid<R>& grid, double kick);

}  // namespace dreampm
