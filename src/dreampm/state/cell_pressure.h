// The pressure of a projection, as particles have it.
#pragma once
#include <cmath>

#include "dreampm/state/world.h"

namespace dreampm {

/// Pa, of a cell; 0 where none is known.
template <class R>
double cell_pressure(const World<R>& world, const Vec3i& cell) {
  const std::int32_t block = world.grid.blocks.find(world.wrapped(block_of(cell)));
  if (block == BlockList::none) return 0;
  const std::size_t at = static_cast<std::size_t>(block) * block_nodes +
                         static_cast<std::size_t>(node_index(cell.x & 3, cell.y & 3, cell.z & 3));
  return at < world.cell_pressure.size() ? static_cast<double>(world.cell_pressure[at]) : 0;
}

/// Calls body(Pa) for the cell that each particle of a set is in, in their order.
template <class R, class Body>
void for_cell_pressures(const World<R>& world, std::size_t s, const Body& body) {
  const ParticleSet<R>& set = world.sets.at(s);
  for (std::size_t b = 0; b + 1 < set.block_start.size(); ++b)
    for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
      Vec3i cell = first_stencil(world.particle_blocks[b]);
      for (int a = 0; a < 3; ++a)
        cell[a] += static_cast<std::int32_t>(std::floor(set.u[static_cast<std::size_t>(a)][p] + R(0.5)));
      body(cell_pressure(world, cell));
    }
}

}  // namespace dreampm
