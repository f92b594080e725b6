#include "dreampm/backend/gpu/grid_layout.h"

#include <utility>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {

void GridLayout::carry(World<float>& world, Memory& memory) {
  topology_.find_before(world, before_home_);
  before_.upload(before_home_);
  const std::size_t blocks = world.grid.blocks.size();
  Buffer<Node<float>>& carried = some_.spare();
  visit_nodes(world.grid, [&](const auto& field, Nodes<float>& nodes) {
    if (nodes.empty() && !goes_on(field, world, nodes)) return;
    Buffer<Node<float>>& there = memory.nodes[target_of(world.grid, nodes)];
    carried.resize(goes_on(field, world, nodes) ? blocks * block_nodes : 0);
    if (carried.size() > 0) launch(*device_, CarryNodes{before_.data(), there.data(), carried.data()}, blocks);
    std::swap(there, carried);
    resize_for_overwrite(nodes, there.size());
  });
}

}  // namespace dreampm::gpu
