// Numbers that passes over particles share, on any device.
#pragma once

namespace dreampm {

/// Columns of state that a material may have (docs/howto/add-a-material.md).
inline constexpr int most_state_columns = 16;

/// Stands for the distance of a particle that does not need it exactly.
inline constexpr float no_distance = 1e30f;

}  // namespace dreampm
