#include "dreampm/backend/gpu/some_blocks.h"

#include <algorithm>
#include <utility>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm::gpu {

void SomePlaces::download(World<float>& world, Memory& memory, const std::vector<std::uint32_t>& blocks) {
  if (blocks.empty()) return;
  blocks_.upload(blocks);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    ParticleSet<float>& set = world.sets[s];
    if (set.size() == 0) continue;
    SetMemory& there = memory.sets[s];
    begin_.clear();
    std::uint32_t count = 0;
    for (const std::uint32_t b : blocks) {
      begin_.push_back(count);
      count += set.block_start[b + 1] - set.block_start[b];
    }
    if (count == 0) continue;
    to_.upload(begin_);
    CopyPlaces copy{blocks_.data(), to_.data(), there.block_start.data(), {}, {}};
    for (std::size_t a = 0; a < 3; ++a) {
      there.next.u[a].resize(count);
      copy.u[a] = there.now.u[a].data(), copy.copies[a] = there.next.u[a].data();
    }
    launch(*device_, copy, blocks.size());
    resize_for_overwrite(home_, count);
    for (std::size_t a = 0; a < 3; ++a) {
      there.next.u[a].download(home_);
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        const std::uint32_t first = set.block_start[blocks[i]], end = set.block_start[blocks[i] + 1];
        std::copy_n(home_.data() + begin_[i], end - first, set.u[a].data() + first);
      }
    }
  }
}

void SomeNodes::choose(std::vector<std::uint32_t> blocks) {
  chosen_ = std::move(blocks);
  blocks_.upload(chosen_);
}

template <class Body>
void SomeNodes::each_block(World<float>& world, std::size_t target, const Body& one) {
  Nodes<float>& field = host_field(world.grid, target);
  for (std::size_t i = 0; i < chosen_.size(); ++i)
    one(field.data() + std::size_t{chosen_[i]} * block_nodes, home_.data() + i * block_nodes);
}

void SomeNodes::download(World<float>& world, Memory& memory, std::size_t target) {
  if (chosen_.empty()) return;
  copies_.resize(chosen_.size() * block_nodes);
  resize_for_overwrite(home_, copies_.size());
  launch(*device_, CopyBlocks{blocks_.data(), memory.nodes[target].data(), copies_.data(), false}, chosen_.size());
  copies_.download(home_);
  each_block(world, target, [](Node<float>* here, const Node<float>* there) { std::copy_n(there, block_nodes, here); });
}

void SomeNodes::upload(World<float>& world, Memory& memory, std::size_t target) {
  if (chosen_.empty()) return;
  resize_for_overwrite(home_, chosen_.size() * block_nodes);
  each_block(world, target, [](const Node<float>* here, Node<float>* there) { std::copy_n(here, block_nodes, there); });
  copies_.upload(home_);
  launch(*device_, CopyBlocks{blocks_.data(), memory.nodes[target].data(), copies_.data(), true}, chosen_.size());
}

}  // namespace dreampm::gpu
