// The walls of a simulation's box.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace dreampm {

/// A wall of the box; y_min is the floor.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };
constexpr std::size_t index(Side side) { return static_cast<std::size_t>(side); }

/// The names of the sides in scene files, in the order of Side.
inline constexpr std::array<std::string_view, 6> side_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// The wall of that name, `floor` and `ceiling` too.
constexpr std::optional<Side> side_called(std::string_view name) {
  if (name == "floor") return Side::y_min;
  if (name == "ceiling") return Side::y_max;
  for (std::size_t s = 0; s < side_names.size(); ++s)
    if (side_names[s] == name) return static_cast<Side>(s);
  return std::nullopt;
}

/// The effect of a surface on matter. open: no wall; separate: matter may leave, and must not
/// enter; slip: it neither enters nor leaves; stick: it moves with the wall.
enum class WallType : std::uint8_t { separate, slip, stick, open };

/// The names of the types in scene files, in the order of WallType.
inline constexpr std::array<std::string_view, 4> wall_type_names{"separate", "slip", "stick", "open"};

struct Wall {
  WallType type = WallType::separate;
  double friction = 0;         ///< Coulomb's coefficient, 0 to 100; of separate and slip
  bool skin_friction = false;  ///< true if it slows liquids as a smooth wall with a boundary layer does
  bool operator==(const Wall&) const = default;
};

}  // namespace dreampm
