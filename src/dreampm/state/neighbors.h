// The blocks around a block: all 27, itself in the middle, those of the grid that its particles
// reach, and the union of what many reach.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// Returns the offset of neighbor `n`, in [0, 27), of a block; 13 is the block itself, 26 - n lies
/// opposite.
constexpr Vec3i neighbor_offset(int n) { return {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}; }

/// The blocks around one as indices into a list, BlockList::none where one is missing. On periodic
/// axes of one or two blocks a neighbor comes more than once, and may be the block itself.
using Neighbors = std::array<std::int32_t, 27>;
template <class R>
Neighbors neighbors_in(const BlockList& list, const World<R>& world, const Vec3i& block);

/// Returns the offset of number `n`, in [0, 8), of the grid's blocks that a block of particles
/// reaches.
constexpr Vec3i stencil_block_offset(int n) { return {n / 4, n / 2 % 2, n % 2}; }
/// The grid's blocks that a block of particles reaches, as indices into a list; BlockList::none
/// where one is missing. On periodic axes of one block each comes twice.
using StencilBlocks = std::array<std::int32_t, 8>;
template <class R>
StencilBlocks stencil_blocks_in(const BlockList& list, const World<R>& world, const Vec3i& block);

/// A block and some of those around it, from -1 to 2 along each axis, a bit each.
struct HaloMask {
  Vec3i block;
  std::uint64_t around;
};
/// The bit of the block that lies there, and where that of a bit lies.
constexpr std::uint64_t halo_bit(const Vec3i& offset) {
  return std::uint64_t{1} << ((offset.x + 1) * 16 + (offset.y + 1) * 4 + offset.z + 1);
}
constexpr Vec3i halo_offset(int bit) { return {bit / 16 - 1, bit / 4 % 4 - 1, bit % 4 - 1}; }

/// Finds the union of halos by merging lists, axis by axis: a list in order stays in order when all
/// its blocks move alike. Keeps its working memory.
class HaloUnion {
 public:
  /// The blocks that any of `from` reaches, brought into the domain on periodic axes, in order and
  /// without duplicates. `from` has to be in order; it is overwritten. What is returned may be
  /// swapped away, until the next call.
  template <class R>
  std::vector<Vec3i>& operator()(const World<R>& world, std::vector<HaloMask>& from);

 private:
  std::vector<HaloMask> other_;
  std::vector<Vec3i> blocks_, wrapped_, merged_;
};

}  // namespace dreampm
