#include "dreampm/state/neighbours.h"

#include <algorithm>
#include <iterator>

namespace dreampm {
namespace {

/// Moves the blocks of `from` by -1, 0 and 1 along an axis and merges the three lists. The first third of a block's
/// bits, `bits` of them, goes with -1, and so on: axis after axis, what is left of the bits shrinks to one.
void spread_along(int axis, int bits, const std::vector<Reach>& from, std::vector<Reach>& to) {
  to.clear();
  const std::uint32_t third = (1u << bits) - 1;
  std::array<std::size_t, 3> at{};
  std::array<Vec3i, 3> head{};
  const auto bits_of = [&](std::size_t side) {
    return from[at[side]].around >> (static_cast<int>(side) * bits) & third;
  };
  const auto find_head = [&](std::size_t side) {
    while (at[side] < from.size() && !bits_of(side)) ++at[side];
    if (at[side] == from.size()) return;
    head[side] = from[at[side]].block;
    head[side][axis] += static_cast<std::int32_t>(side) - 1;
  };
  for (std::size_t side = 0; side < 3; ++side) find_head(side);
  for (;;) {
    std::size_t least = 3;
    for (std::size_t side = 0; side < 3; ++side)
      if (at[side] < from.size() && (least == 3 || before(head[side], head[least]))) least = side;
    if (least == 3) return;
    Reach next{head[least], 0};
    for (std::size_t side = 0; side < 3; ++side) {
      if (at[side] == from.size() || !(head[side] == next.block)) continue;
      next.around |= bits_of(side);
      ++at[side];
      find_head(side);
    }
    to.push_back(next);
  }
}

}  // namespace

template <class R>
Neighbours neighbours_in(const BlockList& list, const World<R>& world, const Vec3i& block) {
  Neighbours around;
  // Where z does not wrap between them, three of a column lie one after the other.
  const bool seam = world.periodic[2] && (world.wrapped(block + Vec3i{0, 0, -1}).z != block.z - 1 ||
                                          world.wrapped(block + Vec3i{0, 0, 1}).z != block.z + 1);
  for (std::size_t n = 0; n < 27; n += 3) {
    const Vec3i first = block + neighbour_offset(static_cast<int>(n));
    if (seam) {
      for (int k = 0; k < 3; ++k)
        around[n + static_cast<std::size_t>(k)] = list.find(world.wrapped(first + Vec3i{0, 0, k}));
      continue;
    }
    const Vec3i column = world.wrapped(first);
    const auto three = list.find_three({column.x, column.y, first.z});
    std::copy(three.begin(), three.end(), around.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return around;
}

template <class R>
std::vector<Vec3i>& Spread::operator()(const World<R>& world, std::vector<Reach>& from) {
  spread_along(0, 9, from, other_);
  spread_along(1, 3, other_, from);
  spread_along(2, 1, from, other_);
  blocks_.clear();
  wrapped_.clear();
  for (const Reach& r : other_) {
    const Vec3i b = world.wrapped(r.block);
    (b == r.block ? blocks_ : wrapped_).push_back(b);
  }
  if (wrapped_.empty()) return blocks_;
  std::sort(wrapped_.begin(), wrapped_.end(), before);
  wrapped_.erase(std::unique(wrapped_.begin(), wrapped_.end()), wrapped_.end());
  merged_.clear();
  std::set_union(blocks_.begin(), blocks_.end(), wrapped_.begin(), wrapped_.end(), std::back_inserter(merged_), before);
  return merged_;
}

template Neighbours neighbours_in(const BlockList&, const World<float>&, const Vec3i&);
template Neighbours neighbours_in(const BlockList&, const World<double>&, const Vec3i&);
template std::vector<Vec3i>& Spread::operator()(const World<float>&, std::vector<Reach>&);
template std::vector<Vec3i>& Spread::operator()(const World<double>&, std::vector<Reach>&);

}  // namespace dreampm
