// The 27 blocks around a block, itself in the middle: found in a list, and the union of those around many.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// Where neighbour `n`, in [0, 27), of a block lies; 13 is the block itself, 26 - n lies opposite.
constexpr Vec3i neighbour_offset(int n) { return {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}; }

/// The blocks around one as indices into a list, BlockList::none where one is missing. On periodic axes of one or two
/// blocks a neighbour comes more than once, and may be the block itself.
using Neighbours = std::array<std::int32_t, 27>;
template <class R>
Neighbours neighbours_in(const BlockList& list, const World<R>& world, const Vec3i& block);

/// A block and some of those around it: bit n stands for neighbour n.
struct Reach {
  Vec3i block;
  std::uint32_t around;
};
inline constexpr std::uint32_t all_around = (1u << 27) - 1;

/// Finds the union of what blocks reach by merging, axis by axis: a list in order stays so when all its blocks move
/// alike. Keeps the memory that it works with.
class Spread {
 public:
  /// The blocks that any of `from` reaches, brought into the domain on periodic axes, in order and without duplicates.
  /// `from` has to be in order; it is used as room. What is returned may be swapped away, until the next call.
  template <class R>
  std::vector<Vec3i>& operator()(const World<R>& world, std::vector<Reach>& from);

 private:
  std::vector<Reach> other_;
  std::vector<Vec3i> blocks_, wrapped_, merged_;
};

}  // namespace dreampm
