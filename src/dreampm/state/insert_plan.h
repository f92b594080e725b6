// The plan of an insertion, from the places of the new particles and the lists of blocks alone:
// whoever holds the particles there are moves them up.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Particles that come into a set, each behind those that its block has, in their order.
template <class R>
class InsertPlan {
 public:
  /// Throws RunError where a seed has no finite position. Changes nothing of the world.
  InsertPlan(const World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds);

  /// Gives the world the list of blocks with those of the seeds, and every set its starts there:
  /// blocks that are new are empty. Called again, it takes both back.
  void exchange(World<R>& world);

  /// By seed: its block, and its place there.
  const std::vector<typename World<R>::BlockPosition>& places() const { return places_; }
  /// By seed: the number of its block in the new list.
  const std::vector<std::uint32_t>& blocks() const { return block_; }
  /// By seed: its number in the set.
  const std::vector<std::uint32_t>& numbers() const { return number_; }
  /// block_start of the set with the seeds, in the new list.
  std::vector<std::uint32_t>& start() { return start_; }
  /// Particles that the set may come to hold: with the pools of its emitters, all memory of its
  /// columns is taken when the first of them comes in.
  std::size_t room() const { return room_; }

 private:
  void find_blocks(const World<R>& world);
  void add_blocks(const World<R>& world, BlockList& blocks, std::vector<Vec3i> more);
  void find_numbers(const World<R>& world, std::size_t set);

  std::vector<typename World<R>::BlockPosition> places_;
  std::vector<std::uint32_t> block_, number_, start_;
  std::size_t room_ = 0;
  // What exchange() exchanges, where any is another.
  bool other_lists_ = false;
  std::vector<Vec3i> list_;
  std::vector<std::vector<std::uint32_t>> starts_;  ///< by set
};

}  // namespace dreampm
