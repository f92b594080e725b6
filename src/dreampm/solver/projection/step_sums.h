// What a step of the projection did to momentum, energy and volume: read off its grid, for reports
// alone.
#pragma once
#include "dreampm/backend/backend.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// After the pressure is solved for: what walls and colliders gave to the liquid by it, over the
/// closed parts of its cells' faces, each with the pressure at the surface there. What a collider
/// hides of a wall is the collider's. `mass`: of a full cell [kg]; `kick`: what gravity gave [m/s].
template <class R>
void add_contact(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut, double mass, const Vec3d& kick,
                 GridStats& to);

/// Sums over the faces, each by the particles that it has: times the mass of one they are those of
/// the liquid.
struct FaceSums {
  double given = 0;      ///< u^2/2 [m^2/s^2] by the particles,
  double pushed = 0;     ///< after gravity,
  double projected = 0;  ///< and after the pressure
  Vec3d places{};        ///< of the particles [m]
};
/// After velocities are extended. `kick`: what gravity gave [m/s].
template <class R>
FaceSums face_sums(const World<R>& world, const MacGrid<R>& grid, const Vec3d& kick);

/// Cells by which liquid takes more room than at rest where it is on all sides; below 0: less.
template <class R>
double excess_volume(const MacGrid<R>& grid);

/// J, of all particles, as the ledger counts it.
template <class R>
double kinetic_of(const World<R>& world);

}  // namespace dreampm
