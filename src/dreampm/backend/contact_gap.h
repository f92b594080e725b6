// How far solids and grains are from the walls and colliders that their nodes touch. A node's
// kernel reaches a wall when the nearest particle is still 1.5 cells away; were contact to begin
// there, a falling body would come to rest about a cell above the floor. So contact lets matter
// approach until the gap between the particles and the wall has closed (Nairn 2013, Comput. Model.
// Eng. Sci. 92:271, closes it by extrapolated positions). Liquids need no gap: their density
// carries them to the wall.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/backend/near_nodes.h"
#include "dreampm/base/thread_team.h"
#include "dreampm/contact/obstacles.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {

/// The gap before a wall at the 16 nodes of a block that lie side by side on it [cells]; 0 where it
/// is closed.
using WallGap = std::array<float, block_width * block_width>;

/// Hold the places of a block's particles, as ParticleSet::u.
template <class R>
struct Bounds {
  Vec3<R> low, high;
};

/// The gaps at the current places of the particles. Each is a minimum, so that results do not
/// depend on the number of threads.
class ContactGaps {
 public:
  /// Must be called after every change of the grid's block list or of the particles' order.
  template <class R>
  void prepare(const World<R>& world, const Obstacles& obstacles);
  // A pass that moves particles may measure each block as it leaves it, while the processor still
  // has the places at hand: clear_block() of all blocks of the grid, measure_block() of all blocks
  // of particles, set_measured(). A block of the grid is cleared before particles that reach it are
  // measured, and two blocks of particles that reach one are not measured at once.
  void clear_block(std::size_t block);
  template <class R>
  void measure_block(std::size_t block, const World<R>& world, const Obstacles& obstacles, const Bounds<R>& bounds);
  void set_measured() { measured_ = true; }
  /// Finds all gaps at the particles' places, which are those of the pass that measured last, if
  /// any did since prepare(). All threads of a team call it together.
  template <class R>
  void measure(ThreadTeam& team, const World<R>& world, const Obstacles& obstacles);

  /// True if matter of that field of the grid has gaps.
  template <class R>
  bool has(const World<R>& world, std::size_t field) const {
    return !near_blocks_.empty() && !world.holds_liquid(field);
  }
  /// The gaps before the wall of a side, at the nodes of a grid block that has nodes on the wall or
  /// behind it, in the order of node_in_plane. Null where no matter is near.
  const WallGap* at_wall(std::size_t block, int side) const {
    const std::int32_t t = walls_of_.empty() ? -1 : walls_of_[block][static_cast<std::size_t>(side)];
    return t < 0 ? nullptr : &walls_[static_cast<std::size_t>(t)].gap;
  }
  /// The gap where no matter is near [cells]: none closes it within a step.
  static constexpr float none = 1e6f;
  /// The nodes among these whose gap is closed, a bit each.
  std::uint16_t closed(std::size_t block, int side) const;
  /// The gaps before points of the colliders' surface in one block.
  class AtPoints {
   public:
    /// `around`: the grid blocks around the block of the points.
    AtPoints(const ContactGaps& gaps, const Neighbors& around);
    /// The gap before a point [cells]: that of matter within a cell whose nearest face has about
    /// the same normal.
    float at(const SurfacePoint& point);

   private:
    /// The smallest gap of the particles whose stencils begin at a node or beside it, by the first
    /// node of a point's stencil, from -1 on along each axis: many points ask for the same.
    static constexpr int width = block_width + 1;
    using Smallest = std::array<float, width * width * width>;
    void find_smallest(int side);

    const ContactGaps& gaps_;
    std::array<std::int32_t, 27> slots_;  ///< of the blocks around, as in gaps_of_
    std::array<std::uint8_t, 6> any_{};   ///< whether any gap of a side is there
    std::array<Smallest, 6> smallest_;
    std::array<bool, 6> known_{};
  };

  // What was prepared, for who measures elsewhere.

  /// A block of particles near walls or colliders.
  struct NearBlock {
    std::uint32_t block;
    bool colliders;
    StencilBlocks stencil_blocks;
    std::array<std::int8_t, 6> plane;  ///< of the walls, counted from the first node that it reaches; -1: out of reach
    std::size_t nodes;                 ///< its place in near_nodes_, if colliders are near
  };
  /// The nodes of one grid block that lie on a wall or behind it.
  struct WallNodes {
    std::array<std::int32_t, 4> from;  ///< slots of the blocks with the wall: itself, those before it along both axes
    int side, plane;                   ///< the plane of nodes within those blocks
    WallGap gap;
  };
  const std::vector<NearBlock>& near_blocks() const { return near_blocks_; }
  const std::vector<WallNodes>& wall_nodes() const { return walls_; }
  /// By grid block: the number of its gaps, in all `gap_count()`; -1 of those away from walls and
  /// colliders.
  const std::vector<std::int32_t>& gaps_of() const { return gaps_of_; }
  std::size_t gap_count() const { return cell_gaps_.size(); }
  /// By grid block and side: a number of `wall_nodes`; -1: none.
  const std::vector<std::array<std::int32_t, 6>>& walls_of() const { return walls_of_; }
  /// True if particles of that block may be in reach of colliders.
  bool reaches_colliders(const NearBlock& near_block, const Obstacles& obstacles) const;

 private:
  /// The smallest gap of the particles whose stencils begin at each node of a block, by the side of
  /// the box whose normal is nearest to that of the face.
  using SideGaps = std::array<float, block_nodes>;
  struct CellGaps {
    std::array<SideGaps, 6> gap;
    std::array<std::uint8_t, 6> any{1, 1, 1, 1, 1, 1};  ///< whether any of a side may be less than `none`
  };
  /// Returns the gaps of one side, or empty ones; `slots` as in gaps_of_.
  const SideGaps& gaps_at(std::int32_t slots, int side) const;
  bool any_at(std::int32_t slots, int side) const {
    return slots >= 0 && cell_gaps_[static_cast<std::size_t>(slots)].any[static_cast<std::size_t>(side)] != 0;
  }

  // `alone`: no other thread measures a block that has nodes in common with this one.
  template <class R>
  void measure_block(const NearBlock& near_block, const World<R>& world, const Obstacles& obstacles,
                     const Bounds<R>& bounds, bool alone);
  template <class R>
  void measure_wall(const NearBlock& near_block, int side, const ParticleSet<R>& set, double dx,
                    const Bounds<R>& bounds, bool alone);
  template <class R>
  void measure_colliders(const NearBlock& near_block, const ParticleSet<R>& set, double dx, const Obstacles& obstacles,
                         bool alone);
  void find_wall_gap(WallNodes& wall) const;
  /// The gap of a node, counted from the first one that the near_block reaches, and of those behind
  /// it in its block. Null where no gaps are kept.
  float* gap_slot(const NearBlock& near_block, int side, const Vec3i& node);

  bool measured_ = false;  ///< by a pass
  std::vector<NearBlock> near_blocks_;
  std::vector<std::int32_t> near_block_of_;  ///< by block of particles; -1: none
  std::vector<NearNodes> near_nodes_;
  std::vector<std::int32_t> gaps_of_;
  std::vector<CellGaps> cell_gaps_;
  std::vector<WallNodes> walls_;
  std::vector<std::array<std::int32_t, 6>> walls_of_;
};

}  // namespace dreampm
