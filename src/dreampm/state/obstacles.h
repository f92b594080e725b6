// What colliders mean to the matter in a block: where their surfaces are, how far its nodes are
// from them, and how much of a node's kernel they take. Worked out once a block, when matter first
// comes near, and near colliders that move whenever these have moved.
#pragma once
#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

#include "dreampm/math/vec_hash.h"
#include "dreampm/physics/collider_contact.h"
#include "dreampm/state/body_surface.h"
#include "dreampm/state/collider_view.h"
#include "dreampm/state/obstacle_nodes.h"
#include "dreampm/state/surface_points.h"

namespace dreampm {

/// A cache over the colliders as they stand; not state: it can be thrown away at any time.
class Obstacles {
 public:
  /// Fills the cache for all grid blocks of the world; call after every regroup, and after
  /// colliders have moved. While they stand it takes memory only for blocks that were never part of
  /// the grid, and for longer lists than ever.
  template <class R>
  void prepare(const World<R>& world);
  /// The nodes of that grid block that colliders touch; empty for most.
  const std::vector<ObstacleNode>& at(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->nodes : none_.nodes;
  }
  /// The points of surfaces in that grid block.
  const std::vector<SurfacePoint>& points(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->points : none_.points;
  }
  /// Whether a collider is near that grid block: within reach of particles that reach its nodes.
  bool near(std::size_t grid_block) const { return by_block_[grid_block] != nullptr; }
  /// At the nodes of the grid the distance from the nearest collider [cells], negative inside, as
  /// the last number, after its gradient; empty without colliders.
  const Nodes<float>& clearance() const { return clearance_; }
  /// The colliders around a block, and its cells in which particles need their exact distance from
  /// them, a bit each.
  struct Thin {
    ColliderView view;
    std::uint64_t cells;
  };
  /// Null where that grid block has no such cells.
  const Thin* thin(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->thin.get() : nullptr;
  }
  /// Whether there are such blocks.
  bool any_thin() const { return any_thin_; }
  bool any() const { return any_; }

 private:
  struct Near {
    std::vector<ObstacleNode> nodes;
    std::vector<SurfacePoint> points;
    std::array<Node<float>, block_nodes> clearance;
    std::unique_ptr<const Thin> thin;   ///< see Obstacles::thin
    std::vector<std::uint16_t> moving;  ///< colliders that move, within reach
  };
  using Cache = std::unordered_map<Vec3i, std::unique_ptr<Near>, Vec3iHash>;

  /// Takes over where the colliders stand, and forgets what is no longer true.
  template <class R>
  void place(const World<R>& world);
  template <class R>
  void find_fixed(const World<R>& world);
  template <class R>
  void find_moving(const World<R>& world);
  /// Fills in what a cache lacks: the `fresh_` blocks of the grid.
  template <class R>
  void look_up(const World<R>& world, ColliderView::See see, Cache& cache, std::vector<const Near*>& by_block);
  /// Colliders that move within reach of a block's nodes.
  template <class R>
  std::vector<std::uint16_t> near_moving(const World<R>& world, const Vec3i& block) const;
  /// Whether what the cache knows of a block is still so, `moving` being near.
  bool is_current(const Near& near, const std::vector<std::uint16_t>& moving) const;
  /// Brings the velocities of colliders up to date.
  template <class R>
  void set_velocities(const World<R>& world, const Vec3i& block, Near& near) const;
  /// Moves the points of rigid bodies to where these stand.
  template <class R>
  void place_bodies(const World<R>& world);
  template <class R>
  std::unique_ptr<Near> find(const World<R>& world, const Vec3i& block, ColliderView::See see) const;

  std::vector<PlacedCollider> placed_;  ///< all of the world
  bool any_move_ = false;
  std::vector<std::vector<BodyPoint>> bodies_;  ///< by collider: the points of one that is a rigid body
  /// A point of a rigid body where it stands.
  struct PlacedPoint {
    Vec3i block;
    std::size_t number;  ///< in the order of colliders, their copies and points
    SurfacePatch patch;  ///< in cells from the block's first node
  };
  std::vector<PlacedPoint> body_points_;           ///< by block, those of a block by number
  std::vector<bool> moved_;                        ///< by collider: whether its surface did since the last call
  Cache fixed_cache_;                              ///< of those that stand still alone; null where none is near
  Cache moving_cache_;                             ///< of all as they stand now, where one that moves is near
  std::vector<Vec3i> blocks_;                      ///< of the grid, as in fixed_
  std::vector<const Near*> fixed_, fixed_before_;  ///< null alike, as in by_block_
  std::vector<const Near*> by_block_;
  std::vector<std::uint32_t> fresh_;  ///< grid blocks that a cache does not know
  Near none_;
  Nodes<float> clearance_;
  bool any_ = false, any_thin_ = false;
};

}  // namespace dreampm
