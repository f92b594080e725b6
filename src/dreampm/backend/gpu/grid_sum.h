// From arenas to the nodes of the grid: each node adds up what the blocks of particles around it
// gave, in a fixed order.
#pragma once
#include "dreampm/backend/gpu/arena.h"
#include "dreampm/backend/gpu/block.h"

namespace dreampm::gpu {

/// Adds up one field; a block of threads takes a block of the grid. On periodic axes of one block a
/// block is more than one corner of an arena, and comes once for each.
struct SumArenas {
  static constexpr int threads = block_nodes;
  struct Shared {};

  const NodeCounts* counts;    ///< `arena_nodes` an arena; null where none was written
  const std::uint32_t* first;  ///< by block of the grid, into `arena` and `corner`, and the end
  const std::int32_t* arena;   ///< block of particles
  const std::int32_t* corner;  ///< which of its eight corners
  const BlockLoad* loads;      ///< by block of particles
  const Node<float>* base;     ///< to add to, or null
  Node<float>* to;
  ScatterBounds bounds;
  int field;  ///< 0 or 1; 2: the mixture

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const int g = block.index();
    block.each_thread([&](int n) {
      double sum[4]{};
      for (std::uint32_t s = first[g]; counts && s < first[g + 1]; ++s) {
        const BlockLoad& load = loads[arena[s]];
        const ScatterUnits units = field == 2 ? mixture_units(load, bounds) : field_units(load, field, bounds);
        const NodeCounts& count = counts[std::int64_t{arena[s]} * arena_nodes + number_in_arena(corner[s], n)];
        const double momentum = per_count(units.momentum), mass = per_count(units.mass);
        sum[0] += count.x * momentum, sum[1] += count.y * momentum, sum[2] += count.z * momentum;
        sum[3] += count.m * mass;
      }
      const std::int64_t at = std::int64_t{g} * block_nodes + n;
      Node<float> node{static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2]),
                       static_cast<float>(sum[3])};
      to[at] = base ? base[at] + node : node;
    });
  }
};

}  // namespace dreampm::gpu
