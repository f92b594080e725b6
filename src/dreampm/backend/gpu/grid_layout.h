// The blocks of the grid of a World whose nodes lie in a device's memory.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/backend/gpu/some_blocks.h"
#include "dreampm/state/grid_topology.h"

namespace dreampm::gpu {

class GridLayout {
 public:
  /// `some` lends its spare room, and has to outlive it.
  GridLayout(Device& device, SomeNodes& some) : device_(&device), some_(some), before_(device) {}
  /// As those of GridTopology.
  bool lay(World<float>& world, std::span<const std::uint64_t> cells) { return topology_.lay(world, cells); }
  void take_back(World<float>& world) { topology_.take_back(world); }
  /// Where lay() returned true: brings the nodes in `memory` to the new places of their blocks; the
  /// World's arrays get their sizes.
  void carry(World<float>& world, Memory& memory);

 private:
  Device* device_;
  SomeNodes& some_;
  GridTopology<float> topology_;
  Buffer<std::int32_t> before_;
  std::vector<std::int32_t> before_home_;
};

/// A bit for each cell, of the two numbers that kernels write for each block.
inline std::vector<std::uint64_t> cells_from(const std::vector<std::uint32_t>& halves) {
  std::vector<std::uint64_t> cells(halves.size() / 2);
  for (std::size_t b = 0; b < cells.size(); ++b) cells[b] = halves[2 * b] | std::uint64_t{halves[2 * b + 1]} << 32;
  return cells;
}

}  // namespace dreampm::gpu
