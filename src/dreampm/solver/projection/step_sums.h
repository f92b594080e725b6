// The sums of a step of the projection: momentum, energy and volume, read off its grid, for reports
// alone.
#pragma once
#include "dreampm/backend/backend.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/viscosity.h"

namespace dreampm {

/// Constants that turn the values of a step's grid into sums.
struct StepScale {
  double particle = 0;  ///< kg, of one of liquid
  double cell = 0;      ///< kg, of a cell of liquid
  Vec3d kick;           ///< m/s, what gravity gave
};

/// Adds the impulses of walls and colliders on the liquid; after velocities are extended. Walls
/// give what their faces stop, and the pressure of the cells beside them; colliders give the
/// pressure over the parts of faces that they close, as it is at their surface. The part of a wall
/// that a collider hides is the collider's. Both include viscosity.
template <class R>
void add_contact(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut, const Viscosity<R>& viscosity,
                 const StepScale& scale, GridStats& to);

struct FaceSums {
  EnergySums energy;
  Vec3d moment{};  ///< of all matter: mass times place [kg m]
};
/// Returns the sums over faces; after velocities are extended.
template <class R>
FaceSums face_sums(const World<R>& world, MacGrid<R>& grid, const StepScale& scale);

/// Cells by which liquid takes more room than at rest where it is on all sides; below 0: less.
/// `rows`: those with liquid.
template <class R>
double excess_volume(const MacGrid<R>& grid, std::span<const CellRows::Row> rows);

/// Returns the volume fraction of the liquid by which cells are more than half too full: where thin
/// sheets come to lie in others, faster than the density takes them apart. `rows`: those with
/// liquid.
template <class R>
double crowding(const MacGrid<R>& grid, std::span<const CellRows::Row> rows);

/// J, of all particles of liquid, as the ledger counts it.
template <class R>
double kinetic_of(const World<R>& world);

}  // namespace dreampm
