// How files outside of state/ and backend/ reach the carried grid: a node at a time, with its
// place.
#pragma once
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

}  // namespace dreampm
