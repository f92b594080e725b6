#include "dreampm/backend/gpu/collider_nodes.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/parallel.h"

namespace dreampm::gpu {

void ColliderNodes::prepare(const World<float>& world, Memory& memory, const Obstacles& obstacles) {
  numbers_.assign(world.grid.blocks.size(), 0);
  const std::size_t nodes = obstacles.any() ? world.grid.nodes.size() : 0;
  memory.clearance.resize(nodes);
  memory.base.resize(world.needs_mixture() ? nodes : 0);
  const auto fill = [&](Buffer<Node<float>>& to, const Node<float>& with) {
    launch(*device_, FillBlocks{to.data(), with}, to.size() / block_nodes);
  };
  fill(memory.clearance, Obstacles::far_away), fill(memory.base, {0, 0, 0, 0});
  colliders_moved(world, memory, obstacles);
}

void ColliderNodes::colliders_moved(const World<float>& world, Memory& memory, const Obstacles& obstacles) {
  std::vector<std::uint32_t> some;
  for (std::size_t b = 0; obstacles.any() && b < numbers_.size(); ++b) {
    const std::uint64_t now = obstacles.number(b);
    if (std::exchange(numbers_[b], now) != now) some.push_back(static_cast<std::uint32_t>(b));
  }
  if (some.empty()) return;
  blocks_.upload(some);
  send(some, memory.clearance, [&](std::size_t b, Node<float>* nodes) {
    std::copy_n(obstacles.clearance().data() + b * block_nodes, block_nodes, nodes);
  });
  if (memory.base.size() > 0)
    send(some, memory.base, [&](std::size_t b, Node<float>* nodes) {
      std::fill_n(nodes, block_nodes, Node<float>{});
      add_colliders(world, obstacles, b, nodes);
    });
}

template <class Nodes>
void ColliderNodes::send(const std::vector<std::uint32_t>& some, Buffer<Node<float>>& to, const Nodes& nodes) {
  copies_home_.resize(some.size() * block_nodes);
  parallel_for(some.size(), 32, [&](std::size_t i) { nodes(some[i], copies_home_.data() + i * block_nodes); });
  copies_.upload(copies_home_);
  launch(*device_, CopyBlocks{blocks_.data(), to.data(), copies_.data(), true}, some.size());
}

}  // namespace dreampm::gpu
