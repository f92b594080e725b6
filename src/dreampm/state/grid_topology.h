// Grid topology: the list of blocks that the grid has, found from where particles are.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dreampm/state/neighbors.h"

namespace dreampm {

/// True if the nodes of a field are there after its blocks have changed. What a sort need not carry
/// new matter must not lose: it comes in before the step that reads it. `present`: the nodes of the
/// world's field.
template <class F, class R>
bool goes_on(const F& field, const World<R>& world, const Nodes<R>& present) {
  return F::use.carried ? field.needed(world) : !present.empty();
}

/// Lays grid blocks wherever the stencils of particles can reach until the next sort, and behind
/// walls that they can reach, and carries the nodes of those over that were there before; new ones
/// are zero. Keeps the memory that it works with.
template <class R>
class GridTopology {
 public:
  /// `cells`: of each block of particles the cells that have any, a bit each, by node_index();
  /// where matter has moved since the last sort its cells are unknown, and all bits are set.
  /// `spare` lends the memory of its fields and gets the former ones for it, as long as the new
  /// ones; their contents are undefined before and after.
  void operator()(World<R>& world, std::span<const std::uint64_t> cells, GridFields<R>& spare);

  // Its two parts, for who holds the nodes elsewhere.

  /// Lays the blocks; whether they are others than before, or a field comes or goes.
  bool lay(World<R>& world, std::span<const std::uint64_t> cells);
  /// By block of the grid, after that: its number before, or BlockList::none.
  void find_before(const World<R>& world, std::vector<std::int32_t>& before) const;
  /// Takes back what lay() did where it returned true, as long as nobody has touched the fields.
  void take_back(World<R>& world) { std::swap(blocks_, world.grid.blocks); }

 private:
  void carry(World<R>& world, GridFields<R>& spare);

  HaloUnion halo_union_;
  std::vector<HaloMask> halos_;
  BlockList blocks_;                  ///< the former ones, while nodes are carried over
  std::vector<std::int32_t> before_;  ///< as find_before
};

}  // namespace dreampm
