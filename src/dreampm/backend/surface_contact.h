// Contact of the grid's matter with colliders at points of their surfaces. Nodes lie where they lie, on either side of
// a surface; what must not enter is the matter between them. So it is the velocity at the surface, v(x_s) = sum w_i
// v_i, that contact acts on, and the impulse that it takes goes to the nodes with the same weights: the pressure of
// matter at rest on a surface then adds up to nothing at every node, whichever way the surface cuts the cells. To stop
// nodes inside the collider instead leaves those outside of it without what the surface presses back with.
#pragma once
#include <array>
#include <vector>

#include "dreampm/backend/block_visit.h"
#include "dreampm/backend/contact_gap.h"
#include "dreampm/base/crew.h"
#include "dreampm/math/bspline.h"
#include "dreampm/state/neighbours.h"
#include "dreampm/state/obstacles.h"

namespace dreampm {

/// Finds impulses l_s of the points along their normals, so that contact holds at all of them at once: no normal
/// velocity where matter slips or sticks, none inward and l_s >= 0 where it may leave. They are the
/// multipliers of the least change of kinetic energy, found by an accelerated projected gradient (Mazhar et al. 2015,
/// ACM Trans. Graph. 34:32), each point divided by the sum of its row of sum_i w_is w_it/m_i: a step that cannot
/// overshoot. At an edge l_s is at most what it is a cell away from it: else it would grow until what flows past the
/// edge stood still with what the face stops. Friction is Coulomb's law at each node for what it received; where matter
/// sticks nodes inside the collider move along its normal alone. No node leaves faster than the fastest of them came:
/// far inside, where weights are many times a node's share of mass, some would.
template <class R>
class SurfaceContact {
 public:
  /// After every change of the grid's block list.
  void prepare(const World<R>& world, const Obstacles& obstacles);
  /// Whether it may change nodes of this grid block.
  bool changes(std::size_t block) const { return !shore_of_.empty() && shore_of_[block] >= 0; }

  /// Nodes of that field of the grid have velocities. Adds what colliders gave to `found`, by grid block: for a node at
  /// several of them to the one that takes most of its kernel. Matter may come nearer as fast as closes its gap in one
  /// step; `per_dt` = dx/dt [m/s]. All members of a crew call it together.
  void operator()(Crew& crew, World<R>& world, const Obstacles& obstacles, std::size_t field, const ContactGaps& gaps,
                  R per_dt, std::vector<BlockFound>& found);

 private:
  /// A point in the course of a solution.
  struct Point {
    Vec3<R> normal;
    R area;  ///< dx^2
    std::uint16_t collider;
    std::size_t begin, end;         ///< of its links
    std::int32_t inland = -1;       ///< the point that limits it, or -1
    R mass = R(0);                  ///< sum w m [kg]
    R gain = R(0);                  ///< impulse for a velocity [kg]; 0 where there is not enough matter to hold
    R approach = R(0);              ///< the speed at which matter may come nearer [m/s]
    std::array<R, 2> impulse = {};  ///< along the normal, by area [kg m/s], after even and odd steps,
    R ahead = R(0);                 ///< and where the next step looks from
    Vec3<R> given = {};             ///< by the last step [kg m/s]
  };
  /// A node in the stencil of a point, as the point sees it ...
  struct Link {
    std::uint32_t node;  ///< in the grid
    R w;
    R part;  ///< of its velocity in that of the point [1]
  };
  /// ... and as the node's shore does.
  struct Gift {
    std::uint32_t point, node;  ///< the node's number within its block
    R w;
    R answer;  ///< velocity that an impulse of the point gives [1/kg]
  };
  /// A block with points.
  struct Home {
    std::size_t block;
    std::size_t begin, end;  ///< of its points
    Neighbours around;       ///< the grid's blocks
    bool met = false;        ///< whether there is matter at any of them
  };
  /// A block whose nodes are in stencils of points.
  struct Shore {
    std::size_t block;
    std::size_t begin = 0, end = 0;           ///< of its gifts
    std::uint64_t held = 0;                   ///< nodes inside colliders where matter sticks, a bit each:
    std::array<Vec3<R>, block_nodes> axis{};  ///< they move along this alone, the collider's normal
    std::array<R, block_nodes> open{};        ///< the part of a node's kernel that no collider takes
    // Of its nodes, in a call.
    bool met = false;                                   ///< whether there is matter at any point of theirs
    R fastest2 = R(0);                                  ///< the square of their largest speed before contact [m^2/s^2]
    std::array<R, block_nodes> area, most;              ///< of points [dx^2], in all and of one,
    std::array<std::uint16_t, block_nodes> collider{};  ///< and whose that one is
    std::array<Vec3<R>, block_nodes> normal;            ///< times area
    std::array<Vec3<R>, block_nodes> before;            ///< velocity before contact [m/s]
  };

  void link(const World<R>& world, const Obstacles& obstacles, std::size_t block);
  void look_inland(const Obstacles& obstacles, const Home& home);
  Shore& shore_of(std::uint32_t node) { return shores_[static_cast<std::size_t>(shore_of_[node / block_nodes])]; }
  /// The part of a node's velocity that it may have.
  static Vec3<R> free_part(const Shore& shore, std::size_t n, const Vec3<R>& v) {
    return shore.held >> n & 1 ? shore.axis[n] * dot(v, shore.axis[n]) : v;
  }
  // In the order of a call.
  void weigh(Home& home, const Nodes<R>& nodes);
  void find_approach(const World<R>& world, const Obstacles& obstacles, const ContactGaps& gaps, const Home& home,
                     R per_dt);
  void measure(Shore& shore, Nodes<R>& nodes);
  void find_gains(const Home& home, const Nodes<R>& nodes);
  void press(const World<R>& world, const Home& home, const Nodes<R>& nodes, int step);
  void give(const Shore& shore, Nodes<R>& nodes) const;
  void rub(const World<R>& world, const Shore& shore, Nodes<R>& nodes) const;
  void slow(const Shore& shore, Nodes<R>& nodes) const;
  void tell(const World<R>& world, const Shore& shore, const Nodes<R>& nodes, bool rubs, BlockFound& found) const;

  std::vector<Home> homes_;
  std::vector<Point> points_;  ///< by home
  std::vector<Link> links_;    ///< by point
  std::vector<Shore> shores_;
  std::vector<Gift> gifts_;             ///< by shore
  std::vector<std::int32_t> shore_of_;  ///< by grid block, or -1
  R fastest2_ = R(0);                   ///< of all shores, as of Shore
};

}  // namespace dreampm
