#include "dreampm/state/neighbors.h"

#include <algorithm>
#include <iterator>

namespace dreampm {
namespace {

/// Moves the blocks of `from` by -1 to 2 along an axis and merges the four lists. The first quarter
/// of a block's bits, `bits` of them, goes with -1, and so on: axis after axis, what is left of the
/// bits shrinks to one.
void spread_along(int axis, int bits, const std::vector<HaloMask>& from, std::vector<HaloMask>& to) {
  to.clear();
  constexpr std::size_t sides = 4;
  const std::uint64_t quarter = (std::uint64_t{1} << bits) - 1;
  std::array<std::size_t, sides> at{};
  std::array<Vec3i, sides> head{};
  const auto bits_of = [&](std::size_t side) {
    return from[at[side]].around >> (static_cast<int>(side) * bits) & quarter;
  };
  const auto find_head = [&](std::size_t side) {
    while (at[side] < from.size() && !bits_of(side)) ++at[side];
    if (at[side] == from.size()) return;
    head[side] = from[at[side]].block;
    head[side][axis] += static_cast<std::int32_t>(side) - 1;
  };
  for (std::size_t side = 0; side < sides; ++side) find_head(side);
  for (;;) {
    std::size_t least = sides;
    for (std::size_t side = 0; side < sides; ++side)
      if (at[side] < from.size() && (least == sides || block_less(head[side], head[least]))) least = side;
    if (least == sides) return;
    HaloMask next{head[least], 0};
    for (std::size_t side = 0; side < sides; ++side) {
      if (at[side] == from.size() || !(head[side] == next.block)) continue;
      next.around |= bits_of(side);
      ++at[side];
      find_head(side);
    }
    to.push_back(next);
  }
}

/// The blocks at offset(n) from one, which come in columns of `depth` along z.
template <std::size_t count, std::size_t depth, class R>
std::array<std::int32_t, count> find_around(const BlockList& list, const World<R>& world, const Vec3i& block,
                                            Vec3i (*offset)(int)) {
  std::array<std::int32_t, count> found;
  // Neighbors of a column are consecutive unless z wraps between them.
  const bool seam = world.periodic[2] && (world.wrapped(block + Vec3i{0, 0, -1}).z != block.z - 1 ||
                                          world.wrapped(block + Vec3i{0, 0, 1}).z != block.z + 1);
  for (std::size_t n = 0; n < count; n += depth) {
    const Vec3i first = block + offset(static_cast<int>(n));
    if (seam) {
      for (std::size_t k = 0; k < depth; ++k)
        found[n + k] = list.find(world.wrapped(first + Vec3i{0, 0, static_cast<std::int32_t>(k)}));
      continue;
    }
    const Vec3i column = world.wrapped(first);
    const auto three = list.find_three({column.x, column.y, first.z});
    std::copy_n(three.begin(), depth, found.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return found;
}

}  // namespace

template <class R>
Neighbors neighbors_in(const BlockList& list, const World<R>& world, const Vec3i& block) {
  return find_around<27, 3>(list, world, block, neighbor_offset);
}

template <class R>
StencilBlocks stencil_blocks_in(const BlockList& list, const World<R>& world, const Vec3i& block) {
  return find_around<8, 2>(list, world, block, stencil_block_offset);
}

template <class R>
std::vector<Vec3i>& HaloUnion::operator()(const World<R>& world, std::vector<HaloMask>& from) {
  spread_along(0, 16, from, other_);
  spread_along(1, 4, other_, from);
  spread_along(2, 1, from, other_);
  blocks_.clear();
  wrapped_.clear();
  for (const HaloMask& r : other_) {
    const Vec3i b = world.wrapped(r.block);
    (b == r.block ? blocks_ : wrapped_).push_back(b);
  }
  if (wrapped_.empty()) return blocks_;
  std::sort(wrapped_.begin(), wrapped_.end(), block_less);
  wrapped_.erase(std::unique(wrapped_.begin(), wrapped_.end()), wrapped_.end());
  merged_.clear();
  std::set_union(blocks_.begin(), blocks_.end(), wrapped_.begin(), wrapped_.end(), std::back_inserter(merged_),
                 block_less);
  return merged_;
}

template Neighbors neighbors_in(const BlockList&, const World<float>&, const Vec3i&);
template Neighbors neighbors_in(const BlockList&, const World<double>&, const Vec3i&);
template StencilBlocks stencil_blocks_in(const BlockList&, const World<float>&, const Vec3i&);
template StencilBlocks stencil_blocks_in(const BlockList&, const World<double>&, const Vec3i&);
template std::vector<Vec3i>& HaloUnion::operator()(const World<float>&, std::vector<HaloMask>&);
template std::vector<Vec3i>& HaloUnion::operator()(const World<double>&, std::vector<HaloMask>&);

}  // namespace dreampm
