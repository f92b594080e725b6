// The cells of a block that hold particles.
#pragma once
#include <array>
#include <cstdint>

#include "dreampm/state/particle_move.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// A bit by node_index() for each cell of a block of particles, as they are sorted, that any set
/// has some in: that in which their stencils begin.
template <class R>
std::uint64_t held_cells(const World<R>& world, std::size_t block) {
  std::array<std::uint8_t, block_nodes> held{};
  for (const ParticleSet<R>& set : world.sets) {
    if (set.size() == 0) continue;
    const R *x = set.u[0].data(), *y = set.u[1].data(), *z = set.u[2].data();
    for (std::size_t p = set.block_start[block]; p < set.block_start[block + 1]; ++p)
      held[static_cast<std::size_t>(held_cell(Vec3<R>{x[p], y[p], z[p]}))] = 1;
  }
  std::uint64_t cells = 0;
  for (std::size_t n = 0; n < block_nodes; ++n) cells |= std::uint64_t{held[n]} << n;
  return cells;
}

}  // namespace dreampm
