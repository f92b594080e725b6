// The phases of a step of the projection on cells and faces, in their order
// (docs/theory/projection.md).
#pragma once
#include <array>
#include <limits>
#include <vector>

#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/multigrid.h"

namespace dreampm {

/// Numbers of the projection.
struct ProjectionNumbers {
  static constexpr double tolerance = 1e-3;  ///< of the pressure's residual, over its right side
  static constexpr int most_iterations = 60;
  /// nu kick/dx^2 below which what viscosity does in a step is lost among what transfers do.
  static constexpr double least_diffusion = 1e-4;
  static constexpr double least_pull = 1e-3;    ///< m/s: of a pressure that opens a surface at a wall
  static constexpr double density_share = 0.5;  ///< of what a cell holds too much or too little, in a step
  static constexpr double most_density = 0.5;   ///< cells: of that, at most
  static constexpr double density_tolerance = 0.1;
  static constexpr int most_density_iterations = 6;
};

/// `free`: velocities of faces before the pressure, of what particles gave, `kick` [m/s] later.
template <class R>
void find_free_velocities(MacGrid<R>& grid, const Vec3d& kick);

/// `density` with its mirror images in the walls, and from it `depth`. `way`: of the step, cells
/// for each m/s.
template <class R>
void find_depths(MacGrid<R>& grid, double way);

/// The matrix of the pressure, and as right side what flows into each cell of liquid [m/s] (Batty,
/// Bertails and Bridson 2007, equation 6).
template <class R>
void fill_matrix(MacGrid<R>& grid, PressureLevel<R>& matrix);

/// The pull of a pressure, in the units of MacGrid::impulse, at which matter leaves walls, in the
/// order of World::walls, and colliders, in that of World::colliders.
struct Leaving {
  static constexpr double never = std::numeric_limits<double>::infinity();
  std::array<double, 6> walls;
  std::vector<double> colliders;
};
/// Cells beside them whose pressure pulls more become surface. Returns how many. `rows`: those with
/// liquid.
template <class R>
std::size_t let_go_of_walls(MacGrid<R>& grid, std::span<const CellRows::Row> rows, const Leaving& leaving);

/// Changes `free` of faces that touch liquid by what the pressure as it stands does, `times` so
/// much.
template <class R>
void add_pressure(MacGrid<R>& grid, double times);

/// `velocity` of faces that touch liquid, without what its pressure stops, and of the walls: 0 but
/// where matter leaves them. Others are unknown.
template <class R>
void apply_pressure(MacGrid<R>& grid, const Leaving& leaving);

/// Velocities around liquid: one layer of faces gets the mean of the known ones beside it, those
/// farther keep what particles brought, and one more layer gets means. Ghost faces behind walls
/// become those before them: walls slip.
template <class R>
void extend_velocities(MacGrid<R>& grid);

/// Fills the right side with a part of the excess of density in cells, and of its lack where liquid
/// is all around (after Kugelstadt, Longva, Thuerey and Bender 2019).
template <class R>
void fill_density_source(const MacGrid<R>& grid, PressureLevel<R>& matrix);

/// `moving` from `velocity` and `displacement`, for a step of `dt` [s].
template <class R>
void find_moving_velocities(MacGrid<R>& grid, double dx, double dt);

}  // namespace dreampm
