// Bounds of the places where particles of a block may be.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// A box that holds the particles of a block, of which none has gone more than `beyond` cells out
/// of it [m], as World::position() has them: all of a periodic axis whose end is that near.
template <class R>
Box3d bounds_of_block(const World<R>& world, const Vec3i& block, int beyond) {
  Box3d box = world.domain();
  for (int a = 0; a < 3; ++a) {
    const std::int32_t first = first_stencil(block)[a] - world.low[a] - beyond;
    const std::int32_t last = first + block_width + 2 * beyond;
    // A particle counts from half a cell behind the first node.
    if (world.periodic[static_cast<std::size_t>(a)] && (first < 0 || last >= world.high[a] - world.low[a])) continue;
    box.min[a] = world.origin[a] + (first + 0.5) * world.dx;
    box.max[a] = world.origin[a] + (last + 0.5) * world.dx;
  }
  return box;
}

inline bool meet(const Box3d& a, const Box3d& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.min[axis] > b.max[axis] || a.max[axis] < b.min[axis]) return false;
  return true;
}

/// True if particles of block number `block` may lie in the box [m], between the steps.
template <class R>
bool block_reaches(const World<R>& world, std::size_t block, const Box3d& box) {
  return meet(bounds_of_block(world, world.particle_blocks[block], 1), box);
}
/// The blocks whose particles may lie in one of the boxes, rising.
template <class R>
std::vector<std::uint32_t> blocks_near(const World<R>& world, std::span<const Box3d> boxes) {
  std::vector<std::uint32_t> near;
  for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
    if (std::any_of(boxes.begin(), boxes.end(), [&](const Box3d& box) { return block_reaches(world, b, box); }))
      near.push_back(static_cast<std::uint32_t>(b));
  return near;
}

}  // namespace dreampm
