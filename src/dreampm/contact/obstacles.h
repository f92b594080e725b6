// Obstacles: the colliders near each block of the grid, with points of their surfaces, the
// distances of nodes from them, and the part of each node's kernel that they block. Found once a
// block, when matter first comes near, and again near colliders that moved.
#pragma once
#include <array>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dreampm/contact/block_distances.h"
#include "dreampm/contact/body_kernel.h"
#include "dreampm/contact/body_surface.h"
#include "dreampm/contact/collider_view.h"
#include "dreampm/contact/obstacle_nodes.h"
#include "dreampm/contact/surface_points.h"
#include "dreampm/math/vec_hash.h"
#include "dreampm/physics/collider_contact.h"

namespace dreampm {

/// A cache over the colliders as they stand; not state: it can be thrown away at any time.
class Obstacles {
 public:
  /// Fills the cache for all grid blocks of the world; call after every regroup, and after
  /// colliders have moved. While they stand it takes memory only for blocks that were never part of
  /// the grid, and for longer lists than ever.
  template <class R>
  void prepare(const World<R>& world);
  /// Resets to the initial state, except for the numbers already given to entries.
  void forget() {
    const std::uint64_t given = numbers_;
    *this = {};
    numbers_ = given;
  }
  /// True if the last `prepare` found a change of anything but velocities.
  bool changed() const { return changed_; }
  /// The nodes of that grid block that colliders touch; empty for most.
  const std::vector<ObstacleNode>& at(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->nodes : none_.nodes;
  }
  /// The points of surfaces in that grid block.
  const std::vector<SurfacePoint>& points(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->points : none_.points;
  }
  /// The same number as before means the same points; 0 without any.
  std::uint64_t number(std::size_t grid_block) const {
    return by_block_[grid_block] ? by_block_[grid_block]->number : 0;
  }
  /// True if a collider is near that grid block: within reach of particles that reach its nodes.
  bool near(std::size_t grid_block) const { return by_block_[grid_block] != nullptr; }
  /// The clearance of nodes where no collider is near.
  static constexpr Node<float> far_away{0, 0, 0, static_cast<float>(ColliderContact::clearance_reach)};
  /// Returns for the nodes of the grid the distance from the nearest collider [cells], negative
  /// inside, as the last number, after its gradient; empty without colliders.
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
  /// True if there are such blocks.
  bool any_thin() const { return any_thin_; }
  bool any() const { return any_; }

 private:
  struct Near {
    std::vector<ObstacleNode> nodes;
    std::vector<SurfacePoint> points;
    std::array<Node<float>, block_nodes> clearance;
    std::unique_ptr<const Thin> thin;  ///< see Obstacles::thin
    /// Distances from all colliders but rigid bodies, where there are some.
    std::unique_ptr<const BlockDistances> distances;
    std::vector<std::uint16_t> moving;  ///< colliders of the cache that move, within reach
    std::uint64_t number = 0;           ///< its own, from 1
    std::uint64_t base = 0;             ///< number of the entry of another cache that this one adds to; 0: none
  };
  using Cache = std::unordered_map<Vec3i, std::unique_ptr<Near>, Vec3iHash>;

  /// Takes over where the colliders stand, and forgets what is no longer true.
  template <class R>
  void place(const World<R>& world);
  /// True if the fixed colliders are the same, by the same numbers, so that the entries for them
  /// alone stay valid.
  bool still_fixed(const std::vector<Collider>& now) const;
  template <class R>
  void find_fixed(const World<R>& world);
  /// Replaces entries of `by_block_` by those with the colliders that move: the driven ones or the
  /// rigid bodies.
  template <class R>
  void find_moving(const World<R>& world, ColliderView::See see, Cache& cache);
  /// Fills in what a cache lacks, the `fresh_` blocks of the grid: `find_one(grid_block)`.
  template <class R, class Find>
  void look_up(const World<R>& world, Cache& cache, std::vector<const Near*>& by_block, const Find& find_one);
  /// Returns the moving colliders within reach of a block's nodes; `bounds`: of all colliders, by
  /// number.
  template <class R>
  std::vector<std::uint16_t> near_moving(const World<R>& world, const Vec3i& block, ColliderView::See see,
                                         const std::vector<Box3d>& bounds) const;
  /// True if the cache's entry for a block is still valid, with `moving` near it and `base` beneath
  /// it.
  bool is_current(const Near& near, const std::vector<std::uint16_t>& moving, const Near* base) const;
  /// Brings the velocities of colliders up to date, where some are near that move.
  template <class R>
  void set_velocities(const World<R>& world) const;
  template <class R>
  void set_velocities(const World<R>& world, const Vec3i& block, Near& near) const;
  /// True if no surface moved, and the grid has the same blocks.
  template <class R>
  bool is_as_before(const World<R>& world) const;
  /// Moves the points of rigid bodies to where these stand.
  template <class R>
  void place_bodies(const World<R>& world);
  template <class R>
  std::unique_ptr<Near> find(const World<R>& world, const Vec3i& block, ColliderView::See see) const;
  /// All with those rigid bodies, from what is known of these in their own frames, and of the
  /// others: `base`, which may be null.
  template <class R>
  std::unique_ptr<Near> find_beside(const World<R>& world, const Vec3i& block, const Near* base,
                                    const std::vector<std::uint16_t>& bodies) const;
  /// Adds the points of rigid bodies in the block.
  void add_body_points(ExposedNodes& exposed, const Vec3i& block, std::vector<SurfacePoint>& points) const;

  std::vector<PlacedCollider> placed_;  ///< all of the world
  bool any_driven_ = false;
  /// Tables of a rigid body in its own frame.
  struct Body {
    std::vector<BodyPoint> points;
    BodyKernel kernel;
  };
  std::vector<std::shared_ptr<const Body>> bodies_;  ///< by collider; null where it is no rigid body
  /// A point of a rigid body where it stands.
  struct PlacedPoint {
    Vec3i block;
    std::size_t number;  ///< in the order of colliders, their copies and points
    SurfacePatch patch;  ///< in cells from the block's first node
  };
  std::vector<PlacedPoint> body_points_;           ///< by block, those of a block by number
  std::vector<bool> meets_copy_;                   ///< by collider: whether it may touch its own periodic copies
  std::vector<bool> moved_;                        ///< by collider: whether its surface did since the last call
  Cache fixed_cache_;                              ///< of those that stand still alone; null where none is near
  Cache driven_cache_;                             ///< of these and driven ones as they stand now, near the latter
  Cache body_cache_;                               ///< of all as they stand now, near rigid bodies
  std::vector<Vec3i> blocks_;                      ///< of the grid, as in fixed_
  std::vector<const Near*> fixed_, fixed_before_;  ///< null alike, as in by_block_
  std::vector<const Near*> by_block_;
  std::vector<std::uint32_t> fresh_;  ///< grid blocks that a cache does not know
  /// Near colliders that move: grid blocks, one that driven ones and bodies are near twice.
  std::vector<std::pair<std::uint32_t, Near*>> beside_moving_;
  Near none_;
  Nodes<float> clearance_;
  std::uint64_t numbers_ = 0;  ///< given away
  bool any_ = false, any_thin_ = false, any_rigid_ = false, changed_ = true;
};

}  // namespace dreampm
