// How files outside of state/ and backend/ reach the carried grid: a node at a time, with its
// place.
#pragma once
#include <cmath>
#include <cstdint>

#include "dreampm/state/world.h"

namespace dreampm {

/// Calls body(place, node) for every node of the field that World::field_of gives as 0, `place` its
/// coordinates. Between steps a node holds mass and momentum, with the force of World::dt_next in
/// it. An edit: it ends with an upload (backend/backend.h:Backend::upload).
template <class R, class Body>
void for_each_node(World<R>& world, const Body& body) {
  for (std::size_t b = 0; b < world.grid.blocks.size(); ++b)
    for (int n = 0; n < block_nodes; ++n)
      body(world.grid.blocks[b] * block_width + node_offset(n),
           world.grid.nodes[b * block_nodes + static_cast<std::size_t>(n)]);
}

/// m/s: at the node of that set's field which is nearest to a place, between steps: with the force
/// of World::dt_next in it. 0 where it has no mass.
template <class R>
Vec3d velocity_near(const World<R>& world, const ParticleSet<R>& set, const Vec3d& place) {
  const Vec3d cells = (place - world.origin) * (1 / world.dx);
  Vec3i n;
  for (int a = 0; a < 3; ++a) n[a] = world.low[a] + static_cast<std::int32_t>(std::lround(cells[a]));
  const Vec3i block = block_of(n), in = n - block * block_width;
  const std::int32_t b = world.grid.blocks.find(world.wrapped(block));
  if (b == BlockList::none) return {};
  const Nodes<R>& nodes = world.field_of(set) == 0 ? world.grid.nodes : world.grid.solids;
  const Node<R>& node =
      nodes[static_cast<std::size_t>(b) * block_nodes + static_cast<std::size_t>(node_index(in.x, in.y, in.z))];
  if (!(node.m > R(0))) return {};
  return static_cast<Vec3d>(Vec3<R>{node.x, node.y, node.z}) * (1 / static_cast<double>(node.m));
}

}  // namespace dreampm
