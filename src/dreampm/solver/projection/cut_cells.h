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

/// The colliders of a world as the cells of its grid see them. What is known of a block is kept
/// until a collider near it stands elsewhere.
template <class R>
class CutCells {
 public:
  /// Once the grid of a step is laid, and colliders are where they stand at its end: finds the open
  /// parts and the velocities of the rest, and writes them to the grid.
  void cut(const World<R>& world, MacGrid<R>& grid);
  /// Whether there are colliders.
  bool any() const { return !placed_.empty(); }

  /// The low face of a cell along an axis, of which colliders close a part.
  struct ClosedFace {
    Vec3i cell;
    int axis;
    std::size_t place;  ///< in the arrays of the grid
    double closed;      ///< the part, also of faces on walls
    const ColliderView& view;
    Vec3d middle;  ///< in cells from the block's first node
    /// Whose it is: the nearest collider, by its number in the world.
    std::size_t collider() const { return view.nearest_collider(middle); }
  };
  /// Calls body(ClosedFace) for those of a block, after `cut`.
  template <class Body>
  void for_closed(const World<R>& world, const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    const auto found = blocks_.find(block);
    if (found == blocks_.end() || !found->second) return;
    const Block& cut = *found->second;
    const ColliderView view(world, block, placed_, ColliderView::See::all);
    grid.cells.for_block(block, [&](std::size_t n, std::size_t place) {
      const Vec3i offset = node_offset(static_cast<int>(n));
      for (int a = 0; a < 3; ++a) {
        const R open = cut.open[static_cast<std::size_t>(a)][n];
        if (!(open < R(1))) continue;
        Vec3d middle = static_cast<Vec3d>(offset) + Vec3d{0.5, 0.5, 0.5};
        middle[a] -= 0.5;
        body(ClosedFace{block * block_width + offset, a, place, static_cast<double>(1 - open), view, middle});
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
  /// Of the 64 cells of a block that a collider cuts or fills.
  struct Block {
    std::array<std::array<R, block_nodes>, 3> open;  ///< of the low faces
    std::array<R, block_nodes> room;                 ///< as MacGrid::room
  };
  /// Null where no collider is.
  std::unique_ptr<Block> cut_block(const World<R>& world, const Vec3i& block) const;
  /// Takes the colliders as they stand now; forgets blocks near those that moved.
  void see(const World<R>& world);
  /// Velocities of the faces of a block that colliders close in part.
  void find_velocities(const World<R>& world, const Vec3i& block, MacGrid<R>& grid) const;

  std::vector<PlacedCollider> placed_;
  bool any_moves_ = false;
  std::unordered_map<Vec3i, std::unique_ptr<Block>, Vec3iHash> blocks_;
};

}  // namespace dreampm
