// Space and time: the box in which matter moves, and the time that passes.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "dreampm/vec.h"
#include "dreampm/walls.h"

namespace dreampm {

/// The method by which a world goes on from step to step.
enum class SolverKind : std::uint8_t {
  explicit_steps,  ///< of all materials, as short as sound asks for
  projection       ///< of liquids, whose volume a pressure keeps, as long as their motion allows
};

namespace model {

/// The box that matter moves in.
struct Space {
  Vec3d min{0, 0, 0};             ///< m
  Vec3d max{1, 1, 1};             ///< m, as asked for: the walls lie at `end`
  double spacing = 0.01;          ///< m, between particles; above 0
  double particles_per_cell = 8;  ///< 1 to 64
  std::array<Wall, 6> walls{};    ///< by Side; open on periodic axes
  /// Axes whose two ends meet. Their length is rounded up to whole blocks of 4 cells.
  std::array<bool, 3> periodic{};
  bool operator==(const Space&) const = default;

  double dx() const { return spacing * std::cbrt(particles_per_cell); }  ///< m, the side of a cell
  /// Cells along an axis, as a number that may be more than an integer holds.
  double cells_along(int axis) const {
    constexpr double block = 4;  // the grid wraps by whole blocks
    // The slack keeps a length that is whole but for rounding from growing by a cell.
    const double cells = std::max(1.0, std::ceil((max[axis] - min[axis]) / dx() - 1e-6));
    return periodic[static_cast<std::size_t>(axis)] ? block * std::ceil(cells / block) : cells;
  }
  Vec3i cells() const { return {int(cells_along(0)), int(cells_along(1)), int(cells_along(2))}; }
  /// m: the high corner. Each side is rounded up to whole cells from `min`; the walls lie there.
  Vec3d end() const {
    return {min.x + cells_along(0) * dx(), min.y + cells_along(1) * dx(), min.z + cells_along(2) * dx()};
  }
};

/// The time that passes.
struct Time {
  double fps = 24;   ///< frames a second, above 0
  int frames = 120;  ///< frame 1 is the start, frame n is at (n - 1)/fps
  SolverKind solver = SolverKind::explicit_steps;
  /// Cells that sound or matter may cross in a step, at most 0.5, and by the projection matter
  /// alone (2 as a rule); not used with a fixed dt.
  double cfl = 0.5;
  std::optional<double> dt;      ///< s, fixed step
  std::optional<double> dt_max;  ///< s, longest step
  double damping = 0;            ///< 1/s: velocities decay as exp(-damping t)
  bool surface_contact = true;   ///< contact at surfaces of colliders; false: at nodes, for comparison
  bool operator==(const Time&) const = default;
};

}  // namespace model
}  // namespace dreampm
