// The block-sparse grid: blocks of 4^3 nodes, a sorted list and a lookup. Node coordinates are
// integers; a block's are those of its first node divided by 4. ARCHITECTURE.md, "The step", has a
// drawing of blocks and stencils.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/base/large_vector.h"
#include "dreampm/state/node.h"

namespace dreampm {

/// A field of the grid: the nodes of its blocks, one block after the other.
template <class R>
using Nodes = LargeVector<Node<R>>;

/// The lexicographic order of blocks: x first, then y, then z.
constexpr bool block_less(const Vec3i& a, const Vec3i& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Blocks in lexicographic order of their coordinates, so that the order does not depend on where
/// in space matter is. A block is found by a search along each axis, which is one look where no
/// block is missing between.
class BlockList {
 public:
  static constexpr std::int32_t none = -1;

  /// Sorts and removes duplicates.
  void assign(std::vector<Vec3i> blocks);
  /// Swaps in a list that is in order, without duplicates. Allocates only for lists longer than all
  /// earlier ones.
  void exchange(std::vector<Vec3i>& blocks);
  std::size_t size() const { return blocks_.size(); }
  const Vec3i& operator[](std::size_t i) const { return blocks_[i]; }
  const std::vector<Vec3i>& all() const { return blocks_; }
  /// The index of that block, or `none`.
  std::int32_t find(const Vec3i& block) const;
  /// Returns the indices of block `first` and of the two that follow it along z.
  std::array<std::int32_t, 3> find_three(const Vec3i& first) const;
  /// The index of the first block that is not before `block`; size() if there is none.
  std::size_t first_from(const Vec3i& block) const;

 private:
  /// An entry of the index: a coordinate, and where its blocks begin one level below.
  struct IndexEntry {
    std::int32_t at;
    std::uint32_t begin;
  };
  /// The blocks of a column, along z: indices.
  struct Column {
    std::uint32_t begin, end;
  };
  Column column(std::int32_t x, std::int32_t y) const;
  void make_index();

  std::vector<Vec3i> blocks_;
  std::vector<IndexEntry> planes_;   ///< by x, into columns_; the last one is the end
  std::vector<IndexEntry> columns_;  ///< by y within a plane, into blocks_; the last one is the end
};

/// The block that holds node `n`, for any sign.
constexpr Vec3i block_of(const Vec3i& n) { return {n.x >> 2, n.y >> 2, n.z >> 2}; }
/// The block of a particle whose stencil begins at node `n`.
constexpr Vec3i particle_block_of(const Vec3i& n) { return block_of(n - Vec3i{1, 1, 1}); }

/// The fields of the grid, as they are kept between steps.
template <class R>
struct GridFields {
  /// Every block that a particle's stencil can reach before the next sort, and those behind the
  /// walls among them.
  BlockList blocks;
  /// 0 `nodes`, 1 `solids`, see World::field_of.
  Nodes<R>& field(std::size_t f) { return f == 0 ? nodes : solids; }
  const Nodes<R>& field(std::size_t f) const { return f == 0 ? nodes : solids; }
  Nodes<R> nodes;    ///< blocks.size() * 64
  Nodes<R> solids;   ///< the solids' own field where a scene has liquids too, else empty
  Nodes<R> mixture;  ///< see namespace mixture; the same size where a scene needs it, else empty
  /// Momentum and mass of OldVelocityTerm (physics/particle.h) for `nodes` and for `solids`, after
  /// grid_update velocity; only for fields in which a set keeps its particles' velocities, else
  /// empty.
  std::array<Nodes<R>, 2> velocity_old;
  /// The momentum that stress gives in the coming step, without viscosity, for `nodes` and for
  /// `solids`, which do not contain it. Present only where World::viscous_stages > 0, else empty;
  /// also empty before the first pass, as new matter is at rest.
  std::array<Nodes<R>, 2> stress;
};

}  // namespace dreampm
