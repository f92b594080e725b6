#include "dreampm/state/insert_plan.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

constexpr std::size_t places_at_once = 1 << 10;

template <class R>
std::size_t room_of(const World<R>& world, std::size_t index, std::size_t size) {
  std::uint64_t room = size;
  for (const Emitter& e : world.emitters)
    if (e.set == index) room = e.recycle ? std::max(room, e.pool) : room + (e.pool - std::min(e.pool, e.born));
  return room;
}

}  // namespace

template <class R>
InsertPlan<R>::InsertPlan(const World<R>& world, std::size_t index, std::span<const ParticleSeed> seeds)
    : places_(seeds.size()), block_(seeds.size()), number_(seeds.size()) {
  const ParticleSet<R>& set = world.sets.at(index);
  for (const ParticleSeed& n : seeds)
    if (!is_finite(n.position)) fail_run("a particle of material {} has no finite position", set.name);
  parallel_for(seeds.size(), places_at_once, [&](std::size_t i) { places_[i] = world.locate(seeds[i].position); });
  find_blocks(world);
  find_numbers(world, index);
  room_ = room_of(world, index, start_.back());
}

template <class R>
void InsertPlan<R>::find_blocks(const World<R>& world) {
  BlockList blocks;
  const auto find_all = [&] {
    parallel_for(places_.size(), places_at_once, [&](std::size_t i) {
      block_[i] = static_cast<std::uint32_t>(blocks.find(places_[i].block));  // none is the largest
    });
  };
  std::vector<Vec3i> all = world.particle_blocks;
  blocks.exchange(all);
  find_all();
  std::vector<Vec3i> missing;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (block_[i] == static_cast<std::uint32_t>(BlockList::none) &&
        (missing.empty() || !(missing.back() == places_[i].block)))
      missing.push_back(places_[i].block);
  const bool fits = std::all_of(world.sets.begin(), world.sets.end(), [&](const auto& s) {
    return s.block_start.size() == world.particle_blocks.size() + 1;
  });
  if (missing.empty() && fits) return;
  add_blocks(world, blocks, std::move(missing));
  find_all();
}

/// Old and new particles are then sorted by the same rule.
template <class R>
void InsertPlan<R>::add_blocks(const World<R>& world, BlockList& blocks, std::vector<Vec3i> more) {
  other_lists_ = true;
  more.insert(more.end(), world.particle_blocks.begin(), world.particle_blocks.end());
  blocks.assign(std::move(more));
  list_ = blocks.all();
  for (const ParticleSet<R>& set : world.sets) {
    std::vector<std::uint32_t> start(blocks.size() + 1, 0);
    for (std::size_t b = 0, old = 0; b < blocks.size(); ++b) {
      start[b + 1] = start[b];
      if (old == world.particle_blocks.size() || !(world.particle_blocks[old] == blocks[b])) continue;
      if (!set.block_start.empty()) start[b + 1] += set.block_start[old + 1] - set.block_start[old];
      ++old;
    }
    starts_.push_back(std::move(start));
  }
}

/// The order within a block: particles that were there first, then new ones in their order.
template <class R>
void InsertPlan<R>::find_numbers(const World<R>& world, std::size_t index) {
  const std::vector<std::uint32_t>& before = other_lists_ ? starts_[index] : world.sets[index].block_start;
  const std::size_t blocks = before.size() - 1;
  std::vector<std::uint32_t> next(blocks);
  start_.assign(blocks + 1, 0);
  for (const std::uint32_t b : block_) ++start_[b + 1];
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint32_t there = before[b + 1] - before[b];
    next[b] = start_[b] + there;
    start_[b + 1] += next[b];
  }
  for (std::size_t i = 0; i < block_.size(); ++i) number_[i] = next[block_[i]]++;
}

template <class R>
void InsertPlan<R>::exchange(World<R>& world) {
  if (!other_lists_) return;
  world.particle_blocks.swap(list_);
  for (std::size_t s = 0; s < starts_.size(); ++s) world.sets[s].block_start.swap(starts_[s]);
}

template class InsertPlan<float>;
template class InsertPlan<double>;

}  // namespace dreampm
