// How far solids and grains are from the walls and colliders that their nodes touch. A node's kernel reaches a wall
// when the nearest particle is still 1.5 cells away; were contact to begin there, a falling body would come to rest
// about a cell above the floor. So contact lets matter approach until the gap between the particles and the wall has
// closed (Nairn 2013, Comput. Model. Eng. Sci. 92:271, closes it by extrapolated positions). Liquids need no gap: their
// density carries them to the wall.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/base/thread_team.h"
#include "dreampm/state/neighbours.h"
#include "dreampm/state/obstacles.h"

namespace dreampm {

/// Half of the spacing of particles is what one takes of the room before it; contact begins a little before that, so
/// that the strain of matter in contact does not open it again. In spacings.
inline constexpr double contact_gap = 0.6;

/// The gap before a wall at the 16 nodes of a block that lie side by side on it [cells]; 0 where it is closed.
using WallGap = std::array<float, block_width * block_width>;

/// The gaps of one moment. Results do not depend on the number of threads: each is a minimum.
class ContactGaps {
 public:
  /// After every change of the grid's block list or of the particles' order.
  template <class R>
  void prepare(const World<R>& world, const Obstacles& obstacles);
  /// At the particles' places. All threads of a team call it together.
  template <class R>
  void measure(ThreadTeam& team, const World<R>& world, const Obstacles& obstacles);

  /// Whether matter of that field of the grid has gaps.
  template <class R>
  bool has(const World<R>& world, std::size_t field) const {
    return !homes_.empty() && !world.holds_liquid(field);
  }
  /// Before the wall of that side, at the nodes of a grid block with nodes on it or behind: in the order of
  /// node_in_plane. Null where no matter is near.
  const WallGap* at_wall(std::size_t block, int side) const {
    const std::int32_t t = walls_of_.empty() ? -1 : walls_of_[block][static_cast<std::size_t>(side)];
    return t < 0 ? nullptr : &walls_[static_cast<std::size_t>(t)].gap;
  }
  /// Which of them touch it, a bit each.
  std::uint16_t closed(std::size_t block, int side) const;
  /// Before the surface of colliders at a point of it, seen from its block, which has `around` around it [cells]:
  /// that of matter within a cell which is nearest to a face that looks the same way.
  float at_point(const Neighbours& around, const SurfacePoint& point) const;

 private:
  /// A block of particles near walls or colliders.
  struct Home {
    std::uint32_t block;
    bool colliders;
    StencilBlocks stencil_blocks;
    std::array<std::int8_t, 6> plane;  ///< of the walls, counted from the first node that it reaches; -1: out of reach
  };
  /// What the nodes of a block with nodes on or behind a wall look at.
  struct WallView {
    std::array<std::int32_t, 4> from;  ///< slots of the blocks with the wall: itself, those before it along both axes
    int side, plane;                   ///< the plane of nodes within those blocks
    WallGap gap;
  };
  /// The smallest gap of the particles whose stencils begin at each of a block's nodes, by the side of the box that
  /// the face before them is turned like.
  using Slots = std::array<std::array<float, block_nodes>, 6>;

  template <class R>
  void measure(const Home& home, const World<R>& world, const Obstacles& obstacles);
  template <class R>
  void measure_wall(const Home& home, int side, const ParticleSet<R>& set, double dx);
  template <class R>
  void measure_colliders(const Home& home, const ParticleSet<R>& set, double dx, const Obstacles& obstacles);
  void look(WallView& wall) const;
  /// Of the node so far from the first one that the home reaches.
  template <class R>
  void close(const Home& home, int side, const Vec3i& node, R gap);

  std::vector<Home> homes_;
  std::vector<std::int32_t> slots_of_;  ///< by grid block; -1 of those away from walls and colliders
  std::vector<Slots> slots_;
  std::vector<WallView> walls_;
  std::vector<std::array<std::int32_t, 6>> walls_of_;  ///< by grid block and side; -1: none
};

}  // namespace dreampm
