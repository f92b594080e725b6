// Blocks of nodes on a device: side by side for the way to the host, and back.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/state/node.h"

namespace dreampm::gpu {

/// Copies some blocks of nodes side by side, or back from there.
struct CopyBlocks {
  static constexpr int threads = block_nodes;
  struct Shared {};
  const std::uint32_t* blocks;
  Node<float>*grid, *copies;
  bool back;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const std::int64_t there = std::int64_t{blocks[block.index()]} * block_nodes,
                       here = std::int64_t{block.index()} * block_nodes;
    block.each_thread([&](int t) {
      if (back)
        grid[there + t] = copies[here + t];
      else
        copies[here + t] = grid[there + t];
    });
  }
};

/// Sets all nodes of blocks.
struct FillBlocks {
  static constexpr int threads = block_nodes;
  struct Shared {};
  Node<float>* grid;
  Node<float> with;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) { grid[std::int64_t{block.index()} * block_nodes + t] = with; });
  }
};

}  // namespace dreampm::gpu
