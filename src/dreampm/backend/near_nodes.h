// Nodes in reach of a block of particles, as the search for its gaps before colliders needs them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "dreampm/contact/obstacles.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {

/// Returns the number of the block with that node among those that a block of particles reaches;
/// nodes count from the first of them.
inline std::size_t reached_at(const Vec3i& node) {
  return static_cast<std::size_t>((node.x >> 2) * 4 + (node.y >> 2) * 2 + (node.z >> 2));
}
/// and the node's number in it.
inline std::size_t node_at(const Vec3i& node) {
  return static_cast<std::size_t>(node_index(node.x & 3, node.y & 3, node.z & 3));
}

/// Writes the least of each number and the two that follow at `step`; the last numbers stay as they
/// are: no stencil begins there.
template <std::size_t nodes>
void least_of_three(const float* f, std::array<float, nodes>& to, std::size_t step) {
  float* const t = to.data();
  const auto least = [](float a, float b) { return b < a ? b : a; };
  for (std::size_t i = 0; i < nodes - 2 * step; ++i) t[i] = least(least(f[i], f[i + step]), f[i + 2 * step]);
  for (std::size_t i = nodes - 2 * step; i < nodes; ++i) t[i] = f[i];
}

/// The distance from colliders at the nodes that a block of particles reaches [cells], z fastest,
/// and what the stencils have in common that begin there.
struct NearNodes {
  static constexpr int width = 2 * block_width;
  static constexpr std::size_t size = std::size_t{8} * block_nodes;
  static constexpr std::uint8_t all_sides = 63;
  static std::size_t index(const Vec3i& node) {
    return static_cast<std::size_t>((node.x * width + node.y) * width + node.z);
  }

  std::array<float, size + 1> distance;  ///< one more, so that rows of four can be read
  std::array<float, size> least;         ///< of the nodes of the stencil
  /// The side of the box that the faces before all nodes of the stencil are turned like, a bit; of
  /// more than one where they are not all alike.
  std::array<std::uint8_t, size> sides;
  float nearest;  ///< of all

  void find(const StencilBlocks& blocks, const Obstacles& obstacles);
  /// The mean over the stencil that begins at `first`.
  template <class R>
  R distance_at(const Vec3i& first, const Stencil<R>& stencil) const;
};

}  // namespace dreampm
