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
    const SetMemory& there = memory.sets[s];
    starts_home_.clear();
    std::uint32_t count = 0;
    for (const std::uint32_t b : blocks) {
      starts_home_.push_back(count);
      count += set.block_start[b + 1] - set.block_start[b];
    }
    if (count == 0) continue;
    starts_.upload(starts_home_);
    copies_.resize(count);
    launch(*device_,
           CopyPlaces{{blocks_.data(), there.block_start.data(), starts_.data()},
                      {there.now.u[0].data(), there.now.u[1].data(), there.now.u[2].data()},
                      copies_.data()},
           blocks.size());
    resize_for_overwrite(home_, count);
    copies_.download(home_);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::uint32_t begin = set.block_start[blocks[i]], end = set.block_start[blocks[i] + 1];
      for (std::uint32_t p = begin; p < end; ++p)
        for (int a = 0; a < 3; ++a) set.u[static_cast<std::size_t>(a)][p] = home_[starts_home_[i] + (p - begin)][a];
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
