// Forces on the faces of a step of the projection before its pressure: force fields, damping, the
// friction of walls.
#pragma once
#include "dreampm/backend/impulse_sum.h"
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// The fields of a world change the free velocities for `kick` [s], as gravity does. Returns what
/// they gave.
template <class R>
ImpulseSum apply_fields(const World<R>& world, MacGrid<R>& grid, double kick);

/// Leaves that part of what `free` was before gravity gave `gained`: still water keeps its weight.
template <class R>
void damp(MacGrid<R>& grid, double part, const Vec3d& gained);

/// The parameters of a boundary layer.
struct SkinFriction {
  double viscosity;  ///< m^2/s
  double dx, kick;   ///< m, s
};
/// Slows `free` beside `walls`, in the order of World::walls, by their boundary layers.
template <class R>
void slow_along_walls(MacGrid<R>& grid, const std::array<bool, 6>& walls, const SkinFriction& skin);

}  // namespace dreampm
