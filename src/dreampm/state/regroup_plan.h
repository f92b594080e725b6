// The plan of a sort, from numbers of particles alone: whoever holds the particles counts how many
// of each block move to each block around it, and brings them there.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/state/neighbors.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The first neighbor that is the same block, for each of the 27 and for `nowhere`: on periodic
/// axes of one or two blocks some are. Particles move to that one.
using Alike = std::array<std::uint8_t, 28>;
/// The destination of particles that sinks take, in place of a neighbor.
inline constexpr std::uint8_t nowhere = 27;
template <class R>
Alike first_alike(const World<R>& world);

template <class R>
class RegroupPlan {
 public:
  /// The particles of one set.
  struct Moves {
    /// For each old block and neighbor n, the place where the particles begin that move there,
    /// where those of the block lie in the order of n; [27] is the end of all that stay in the
    /// world.
    std::vector<std::array<std::uint32_t, 28>> runs;
    std::vector<std::uint32_t> start;  ///< block_start of the new blocks
  };
  /// The particles that come to a block: those that leave one of the old blocks for one of its
  /// neighbors, each `old block * 32 + neighbor`, in the order of the old blocks. (More blocks than
  /// fit would need 128 GiB.)
  struct Sources {
    std::uint32_t count = 0;
    std::array<std::uint32_t, 27> of;
  };

  /// Takes the list of blocks over. Fill the runs of all sets then, and call moves_to of every old
  /// block.
  void begin(World<R>& world);
  const BlockList& old_blocks() const { return old_; }
  Moves& moves(std::size_t set) { return moves_[set]; }
  /// `around`: the neighbors that particles of an old block move to, as HaloMask::around.
  void moves_to(std::size_t block, std::uint64_t around) { reach_[block] = {old_[block], around}; }

  /// Finds the blocks that particles come to, where they come from and where each begins; the world
  /// gets the list of blocks. Those more than one box length outside are none, and what comes there
  /// is counted in World::left.
  void find_blocks(World<R>& world);
  const std::vector<Sources>& sources() const { return sources_; }

 private:
  void find_sources(World<R>& world);

  BlockList old_;
  std::vector<HaloMask> reach_;
  HaloUnion spread_;
  std::vector<Sources> sources_;  ///< for every new block
  std::vector<Moves> moves_;
};

}  // namespace dreampm
