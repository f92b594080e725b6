// The walls of a simulation's box.
#pragma once
#include <array>
#include <string_view>

namespace dreampm {

/// A wall of the box; y_min is the floor.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };

/// As scene files have them, in the order of Side.
inline constexpr std::array<std::string_view, 6> side_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// What a wall does to matter.
struct WallState {
  std::string_view type;       ///< separate, slip, stick or open; open on periodic axes
  double friction = 0;         ///< Coulomb's coefficient, at least 0
  bool skin_friction = false;  ///< whether it slows liquids as a smooth wall with a boundary layer does
};

}  // namespace dreampm
