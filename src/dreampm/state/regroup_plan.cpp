#include "dreampm/state/regroup_plan.h"

#include <algorithm>

#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// True if every point of the block is more than a box length outside an open wall.
template <class R>
bool is_beyond(const World<R>& world, const Vec3i& block) {
  const Vec3i size = world.high - world.low;
  for (int a = 0; a < 3; ++a) {
    if (world.periodic[static_cast<std::size_t>(a)]) continue;
    const std::int32_t first = first_stencil(block)[a];
    if (first + block_width < world.low[a] - size[a] || first > world.high[a] + size[a]) return true;
  }
  return false;
}

}  // namespace

template <class R>
Alike first_alike(const World<R>& world) {
  Alike first{};
  first[nowhere] = nowhere;
  for (int n = 0; n < 27; ++n)
    for (int m = n; m >= 0; --m)
      if (world.wrapped(neighbor_offset(m)) == world.wrapped(neighbor_offset(n)))
        first[static_cast<std::size_t>(n)] = static_cast<std::uint8_t>(m);
  return first;
}

template <class R>
void RegroupPlan<R>::begin(World<R>& world) {
  old_.exchange(world.particle_blocks);
  moves_.resize(world.sets.size());
  resize_for_overwrite(reach_, old_.size());
  for (std::size_t s = 0; s < moves_.size(); ++s) {
    resize_for_overwrite(moves_[s].runs, old_.size());
    ParticleSet<R>& set = world.sets[s];
    if (set.block_start.size() != old_.size() + 1) set.block_start.assign(old_.size() + 1, 0);
  }
}

template <class R>
void RegroupPlan<R>::find_blocks(World<R>& world) {
  std::vector<Vec3i>& blocks = spread_(world, reach_);
  std::erase_if(blocks, [&](const Vec3i& b) { return is_beyond(world, b); });
  world.particle_blocks.swap(blocks);
  find_sources(world);
  for (std::size_t s = 0; s < moves_.size(); ++s) {
    auto& start = moves_[s].start;
    start[0] = 0;
    for (std::size_t b = 0; b + 1 < start.size(); ++b) start[b + 1] += start[b];
    world.left += world.sets[s].block_start.back() - start.back();
  }
}

/// Fills the numbers of arrivals in `start`, too.
template <class R>
void RegroupPlan<R>::find_sources(World<R>& world) {
  resize_for_overwrite(sources_, world.particle_blocks.size());
  for (Moves& moves : moves_) resize_for_overwrite(moves.start, world.particle_blocks.size() + 1);
  const auto alike = first_alike(world);
  parallel_for(sources_.size(), 16, [&](std::size_t b) {
    const Neighbors around = neighbors_in(old_, world, world.particle_blocks[b]);
    Sources& from = sources_[b];
    from.count = 0;
    for (Moves& moves : moves_) moves.start[b + 1] = 0;
    for (std::size_t n = 0; n < 27; ++n) {
      // They come from there by going the opposite way.
      const std::size_t way = 26 - n;
      if (around[n] == BlockList::none || alike[way] != way) continue;
      const auto block = static_cast<std::uint32_t>(around[n]);
      std::uint32_t all = 0;
      for (Moves& moves : moves_) {
        const std::uint32_t arrivals = moves.runs[block][way + 1] - moves.runs[block][way];
        moves.start[b + 1] += arrivals;
        all |= arrivals;
      }
      if (all > 0) from.of[from.count++] = block * 32 + static_cast<std::uint32_t>(way);
    }
    std::sort(from.of.begin(), from.of.begin() + from.count);
  });
}

#define DM_INSTANTIATE(R)                      \
  template Alike first_alike(const World<R>&); \
  template class RegroupPlan<R>;
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
