// The block-sparse grid: blocks of 4^3 nodes, a sorted list and a lookup. Node coordinates are
// integers; a block's are those of its first node divided by 4. ARCHITECTURE.md, "The step", has a
// drawing of blocks and stencils.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/base/large_vector.h"
#include "dreampm/math/vec.h"

namespace dreampm {

inline constexpr int block_width = 4;
inline constexpr int block_nodes = block_width * block_width * block_width;

/// Momentum [kg m/s] and mass [kg] between steps; after grid_update velocity [m/s] and mass.
template <class R>
struct alignas(4 * sizeof(R)) Node {
  R x{}, y{}, z{}, m{};
  friend Node operator+(const Node& a, const Node& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.m + b.m}; }
  friend Node operator-(const Node& a, const Node& b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.m - b.m}; }
  friend Node operator*(const Node& a, R s) { return {a.x * s, a.y * s, a.z * s, a.m * s}; }
  friend Node mul_add(const Node& a, R s, const Node& b) { return a * s + b; }
  friend Node mul_sub(const Node& a, R s, const Node& b) { return a * s - b; }
};

/// A field of the grid: the nodes of its blocks, one block after the other.
template <class R>
using Nodes = LargeVector<Node<R>>;

/// The mixture: numbers of a node that the sets share, where there is matter of several kinds or a
/// collider. They lie in the members of a Node, so that all code for nodes handles them too.
namespace mixture {
/// Fraction of the node's kernel that solids and colliders take [1].
template <class N>
constexpr auto& blocked(N& node) {
  return node.x;
}
/// Rest volume of a field's matter over dx^3 [1].
template <class N>
constexpr auto& filled(N& node, std::size_t field) {
  return field == 0 ? node.y : node.z;
}
/// sum w m nu of the liquids [kg m^2/s].
template <class N>
constexpr auto& viscosity(N& node) {
  return node.m;
}
}  // namespace mixture

/// Index of node (i, j, k), each in [0, 4), within its block.
constexpr int node_index(int i, int j, int k) { return (i * block_width + j) * block_width + k; }
/// The step in index from a node of a block to its neighbor along an axis.
inline constexpr int node_step[3] = {node_index(1, 0, 0), node_index(0, 1, 0), node_index(0, 0, 1)};

/// Node number `n` of a block, relative to its first node.
constexpr Vec3i node_offset(int n) {
  return {n / (block_width * block_width), n / block_width % block_width, n % block_width};
}

/// Returns the lowest node at which stencils of a block of particles begin at a sort; they begin at
/// it or one of the next three along each axis. Until the next sort they may begin one node before
/// or after these four. docs/images/blocks.svg shows it.
constexpr Vec3i first_stencil(const Vec3i& block) { return block * block_width + Vec3i{1, 1, 1}; }

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
