// Cells that colliders cut: how much of their faces and of their surroundings is open (Batty,
// Bertails and Bridson 2007).
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "dreampm/math/vec_hash.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/state/collider_view.h"

namespace dreampm {

/// What the pressure of a cell is more, in the units of MacGrid::impulse, on a `way` from its
/// center [cells]: it grows along gravity, which gave `gained` [m/s]. Films are too thin for that.
inline double pressure_on_the_way(double depth, const Vec3d& way, const Vec3d& gained) {
  return depth > 0 ? dot(gained, way) * std::min(1.0, 2 * depth) : 0;
}

/// The colliders of a world as the cells of its grid see them. What is known of a block is kept
/// until a collider near it stands elsewhere.
template <class R>
class CutCells {
 public:
  /// Once the grid of a step is laid, and colliders are where they stand at its end: finds the open
  /// parts and the velocities of the rest, and writes them to the grid.
  void cut(const World<R>& world, MacGrid<R>& grid);
  /// Once rigid bodies have other velocities: writes those of the faces that colliders close in
  /// part.
  void find_velocities(const World<R>& world, MacGrid<R>& grid) const;
  /// Takes the colliders as they stand now, for Rescue; forgets what it knows of blocks near those
  /// that moved.
  void see(const World<R>& world);
  /// Whether there are colliders.
  bool any() const { return !placed_.empty(); }

  /// The low face of a cell along an axis, of which a collider closes a part.
  struct ClosedFace {
    Vec3i cell;
    int axis;
    std::size_t place;  ///< in the arrays of the grid
    double closed;      ///< the part, also of faces on walls
    std::uint16_t owner;
    /// From the centers of the cells on its high and low side to the collider's surface [cells].
    Vec3d to_surface_high, to_surface_low;
    Vec3d middle;  ///< of what is closed, from the low corner of the cell [cells]
  };
  /// Calls body(ClosedFace) for those of a block, after `cut`.
  template <class Body>
  void for_closed(const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    const auto found = blocks_.find(block);
    if (found == blocks_.end() || !found->second) return;
    const Block& cut = *found->second;
    grid.cells.for_block(block, [&](std::size_t n, std::size_t place) {
      const Vec3i cell = node_offset(static_cast<int>(n));
      for (std::size_t a = 0; a < 3; ++a) {
        if (cut.owner[a][n] == grid.no_owner) continue;
        Vec3i low = cell;
        low[static_cast<int>(a)] -= 1;
        body(ClosedFace{block * block_width + cell, static_cast<int>(a), place, static_cast<double>(1 - cut.open[a][n]),
                        cut.owner[a][n], to_surface(cut, cell), to_surface(cut, low), middle_of_closed(cut, a, n)});
      }
    });
  }

  /// Puts particles of one block of particles out of colliders.
  class Rescue {
   public:
    Rescue(const World<R>& world, const CutCells& cells, const Vec3i& block);
    /// Whether a collider is near at all.
    bool is_needed() const { return view_.has_value(); }
    /// `x`: in cells from the node `first`.
    void operator()(const Vec3i& first, Vec3<R>& x) const;

   private:
    Vec3d block_;  ///< its first node
    std::optional<ColliderView> view_;
  };

 private:
  /// Nodes beside a block that the kernels of its cells reach on its low side, and in all.
  static constexpr int node_halo = 1, nodes_along = block_width + 3;
  /// Distances from colliders at the nodes of a block and of those beside it [cells].
  struct NodeDistances {
    std::array<float, nodes_along * nodes_along * nodes_along> at;
    double operator()(int i, int j, int k) const {
      const int n = ((i + node_halo) * nodes_along + j + node_halo) * nodes_along + k + node_halo;
      return static_cast<double>(at[static_cast<std::size_t>(n)]);
    }
    explicit NodeDistances(const ColliderView& view);
  };

  /// Of the 64 cells of a block that a collider cuts or fills.
  struct Block {
    std::array<std::array<R, block_nodes>, 3> open;  ///< of the low faces
    /// The middle of what is not, along the two axes after the face's own, from 0 to 1.
    std::array<std::array<R, block_nodes>, 3> along, up;
    std::array<R, block_nodes> room;                ///< as MacGrid::room
    std::array<std::array<R, block_nodes>, 3> gap;  ///< as MacGrid::gap
    /// As MacGrid::owner.
    std::array<std::array<std::uint16_t, block_nodes>, 3> owner;
    NodeDistances distances;
    explicit Block(const NodeDistances& d) : distances(d) {}
  };
  /// From the low corner of a cell to the middle of what colliders close of its low face [cells].
  static Vec3d middle_of_closed(const Block& cut, std::size_t axis, std::size_t n);
  /// From the center of a cell of a block, or of one before it, to the nearest surface [cells].
  static Vec3d to_surface(const Block& cut, const Vec3i& cell);
  /// Null where no collider is.
  std::unique_ptr<Block> cut_block(const World<R>& world, const Vec3i& block) const;

  std::vector<PlacedCollider> placed_;
  std::unordered_map<Vec3i, std::unique_ptr<Block>, Vec3iHash> blocks_;
};

}  // namespace dreampm
