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
  /// Once rigid bodies have other velocities: writes those of the faces that colliders close in
  /// part.
  void find_velocities(const World<R>& world, MacGrid<R>& grid) const;
  /// Takes the colliders as they stand now, for Rescue; forgets what it knows of blocks near those
  /// that moved.
  void see(const World<R>& world);
  /// Whether there are colliders.
  bool any() const { return !placed_.empty(); }

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
    std::array<std::array<R, block_nodes>, 3> gap;   ///< as MacGrid::gap
    /// As MacGrid::owner.
    std::array<std::array<std::uint16_t, block_nodes>, 3> owner;
  };
  /// Null where no collider is.
  std::unique_ptr<Block> cut_block(const World<R>& world, const Vec3i& block) const;

  std::vector<PlacedCollider> placed_;
  std::unordered_map<Vec3i, std::unique_ptr<Block>, Vec3iHash> blocks_;
};

}  // namespace dreampm
