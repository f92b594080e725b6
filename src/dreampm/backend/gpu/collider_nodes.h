// What the nodes near colliders know of these, in a device's memory: how far they are, and what
// part of the mixture they take. Elsewhere the numbers are always the same, and do not travel.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

class ColliderNodes {
 public:
  explicit ColliderNodes(Device& device) : device_(&device), blocks_(device), copies_(device) {}
  /// Must be called after every change of the grid's block list.
  void prepare(const World<float>& world, Memory& memory, const Obstacles& obstacles);
  /// Must be called after colliders have moved, if nothing else changed.
  void colliders_moved(const World<float>& world, Memory& memory, const Obstacles& obstacles);

 private:
  /// Fills `to` at `some` blocks of the grid; nodes(block, its nodes).
  template <class Nodes>
  void send(const std::vector<std::uint32_t>& some, Buffer<Node<float>>& to, const Nodes& nodes);

  Device* device_;
  std::vector<std::uint64_t> numbers_;  ///< Obstacles::number of what was sent, by block of the grid
  Buffer<std::uint32_t> blocks_;
  Buffer<Node<float>> copies_;
  std::vector<Node<float>> copies_home_;
};

}  // namespace dreampm::gpu
