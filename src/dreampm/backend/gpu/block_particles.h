// How the threads of a block share the particles of a block, and where the nodes around these are.
#pragma once
#include <cstdint>

#include "dreampm/physics/transfer.h"
#include "dreampm/state/node.h"

namespace dreampm::gpu {

/// Calls body(particle) for thread `t`'s share of the particles of a block. `block_start`: by block
/// of particles, and the end.
template <int threads, class Body>
DM_FN void each_particle(const std::uint32_t* block_start, std::uint32_t block, int t, const Body& body) {
  const std::uint32_t end = block_start[block + 1];
  for (std::uint32_t p = block_start[block] + static_cast<std::uint32_t>(t); p < end; p += threads) body(p);
}

/// The same where threads add to nodes. Particles side by side in memory lie in one cell: threads
/// that work together take such as lie far apart, so that they do not all wait for the same nodes.
template <int threads, class Body>
DM_FN void each_particle_apart(const std::uint32_t* block_start, std::uint32_t block, int t, const Body& body) {
  constexpr std::uint32_t together = 32;
  const std::uint32_t begin = block_start[block], count = block_start[block + 1] - begin,
                      stride = (count + together - 1) / together;
  for (auto r = static_cast<std::uint32_t>(t); r < together * stride; r += threads) {
    const std::uint32_t p = r % together * stride + r / together;
    if (p < count) body(begin + p);
  }
}

/// Calls body(i) for the items from 0 up to `count`, one a thread of all blocks.
template <int threads, class Block, class Body>
DM_FN void each_item(Block& block, std::int64_t count, const Body& body) {
  block.each_thread([&](int t) {
    const std::int64_t i = std::int64_t{block.index()} * threads + t;
    if (i < count) body(i);
  });
}

/// Node (i, j, k) of a particle's stencil, in the fields of the grid. `reached`: the eight blocks
/// of the grid that its block reaches, as StencilBlocks.
DM_FN std::int64_t node_in_reach(const std::int32_t* reached, const Stencil<float>& s, int i, int j, int k) {
  const int x = s.node(0) + i + 1, y = s.node(1) + j + 1, z = s.node(2) + k + 1;
  const int corner = (x / block_width * 2 + y / block_width) * 2 + z / block_width;
  return std::int64_t{reached[corner]} * block_nodes + node_index(x % block_width, y % block_width, z % block_width);
}

}  // namespace dreampm::gpu
