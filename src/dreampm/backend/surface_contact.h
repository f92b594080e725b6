// Contact of the grid's matter with colliders at points of their surfaces. A surface cuts the cells
// at any place. So contact acts on the velocity at surface points, v(x_s) = sum w_i v_i, and
// spreads the impulse of a point to the nodes with the same weights: the pressure of matter at rest
// on a surface is then in balance at every node. Stopping the nodes inside the collider instead
// would leave the nodes outside without the reaction of the surface.
#pragma once
#include <array>
#include <vector>

#include "dreampm/backend/block_visit.h"
#include "dreampm/backend/body_coupling.h"
#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/surface_terms.h"
#include "dreampm/base/thread_team.h"
#include "dreampm/contact/obstacles.h"
#include "dreampm/math/bspline.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {

/// Solves for impulses l_s along the normals of all points together: zero normal velocity where
/// matter slips or sticks, no inward velocity and l_s >= 0 where it may separate. The impulses
/// minimise the change of kinetic energy. They are found by an accelerated projected gradient
/// (Mazhar et al. 2015, ACM Trans. Graph. 34:32), preconditioned by the row sums of sum_i w_is
/// w_it/m_i, so that a step cannot overshoot. At an edge l_s is at most its value one cell away
/// from the edge, and what the weight of the matter between adds (the edge limiter): without it the
/// impulse would grow until matter that flows past the edge stood still too; without the weight
/// water would press too little under the low edge of a body that lists. Friction is Coulomb's law
/// at each node, for the impulse that the node received; where matter sticks, nodes inside the
/// collider move along its normal alone. No node leaves faster than the fastest node was before
/// contact: nodes far inside, whose weight is large for their mass, would.
template <class R>
class SurfaceContact {
 public:
  /// Must be called after every change of the grid's block list.
  void prepare(const World<R>& world, const Obstacles& obstacles);
  /// Instead, where the velocities of colliders alone have changed. Returns whether that was
  /// enough.
  bool set_velocities(const World<R>& world, const Obstacles& obstacles);
  /// True if contact may change nodes of this grid block.
  bool changes(std::size_t block) const { return !node_block_index_.empty() && node_block_index_[block] >= 0; }

  /// The nodes of `field` hold velocities; contact acts on what they are relative to the
  /// colliders'. Adds the reactions of colliders to `found`, by grid block: of a node at several
  /// colliders to the one that takes most of its kernel. Matter may approach as fast as closes its
  /// gap in one step; `per_dt` = dx/dt [m/s]. `found` has the mass of each block: what is empty is
  /// passed over. All threads of a team call it together.
  void operator()(ThreadTeam& team, World<R>& world, const Obstacles& obstacles, std::size_t field,
                  const ContactGaps& gaps, R per_dt, std::vector<BlockStats>& found);
  /// The same for all fields that there are.
  void of_all_fields(ThreadTeam& team, World<R>& world, const Obstacles& obstacles, const ContactGaps& gaps, R per_dt,
                     std::vector<BlockStats>& found) {
    for (std::size_t f = 0; f < 2; ++f)
      if (!world.grid.field(f).empty()) (*this)(team, world, obstacles, f, gaps, per_dt, found);
  }
  /// Begins a visit of the fields in a step of `dt` [s] in which rigid bodies are unknowns. Without
  /// it they move as their twists say.
  void begin_bodies(const World<R>& world, double dt) { bodies_.begin(world, dt); }
  void end_bodies() { bodies_ = {}; }

  // What was prepared, for who solves elsewhere.

  /// A point of a collider's surface, and its unknowns.
  struct ContactPoint {
    Vec3<R> normal;
    R area;  ///< dx^2
    std::uint16_t collider;
    std::size_t begin, end;          ///< of its nodes
    Vec3<R> from_edge;               ///< as SurfacePoint::from_edge
    std::size_t live_end = 0;        ///< of those with mass in this call, from `begin` in live_nodes_
    std::int32_t edge_limiter = -1;  ///< the point that limits its impulse at an edge, or -1
    std::int32_t lever = -1;         ///< its place in body_points_, if its collider is a rigid body
    R mass = R(0);                   ///< sum w m [kg]
    R effective_mass = R(0);         ///< impulse per velocity [kg]; 0 where there is too little matter
    R surface_speed = R(0);          ///< along the normal, were its nodes to move with the collider [m/s]
    R approach = R(0);               ///< the speed at which matter may come nearer [m/s]
    bool limits = false;             ///< true if it limits another one
    bool acts = false;               ///< true if its impulse may be other than 0 in this call
    std::array<R, 2> impulse = {};   ///< along the normal, per area [kg m/s], after even and odd steps
    R extrapolated = R(0);           ///< `impulse`, extrapolated by the momentum of the descent
  };
  /// A node in the stencil of a point, in the list of the point ...
  struct PointNode {
    std::uint32_t node;  ///< in the grid
    R w;
  };
  /// ... and the transpose: the point in the list of the node's block.
  struct NodePoint {
    std::uint32_t point;
    std::uint16_t node;  ///< its number within its block
    std::uint16_t rest;  ///< entries of the same point in a row, from this one on
    R w;
  };
  /// The data of a point that nodes read in each call, side by side for them.
  struct ActingPoint {
    Vec3<R> normal;
    R area;  ///< [dx^2]
    R mass;  ///< as ContactPoint::mass; 0 where the point does not act
    std::uint16_t collider;
  };
  /// The same where the node has mass and the point acts: near most surfaces there is no matter,
  /// and the iterations pass over these alone.
  struct LiveNode {
    std::uint32_t node;
    R velocity_weight;  ///< of the node's velocity in that of the point [1]
  };
  struct LivePoint {
    std::uint32_t point, node;
    R inverse_mass;  ///< velocity of the node per impulse of the point [1/kg]
  };
  /// A block that holds points.
  struct PointBlock {
    std::size_t block;
    std::size_t begin, end;                        ///< of its points
    Neighbors around;                              ///< the grid's blocks around it
    std::array<std::uint8_t, 27> same_as{};        ///< the first side with the same block, on periodic axes
    std::array<std::uint32_t, 27> entries{};       ///< number of nodes of points in each block around
    bool has_matter = false;                       ///< true if there is matter at any of its points
    bool acts = false;                             ///< true if any of its points acts
    bool counts = false;                           ///< true if any of its points acts or limits another one
    bool rests = false;                            ///< true if the velocities known of its points are 0
    std::uint64_t number = 0;                      ///< Obstacles::number when its points were found
    bool cleared = false;                          ///< true if its points are as without matter
    int iterations = ColliderContact::iterations;  ///< of its points in each solve
  };
  /// A block with nodes in stencils of points.
  struct NodeBlock {
    std::size_t block;
    std::size_t begin = 0, end = 0;                    ///< of its entries in node_points_
    std::size_t live_end = 0;                          ///< of those in live_points_, from `begin`
    std::size_t runs_end = 0;                          ///< of its runs_, which begin at 27 times its number
    int iterations = ColliderContact::iterations;      ///< most of the points that reach it
    std::uint64_t sticking = 0;                        ///< nodes inside colliders where matter sticks, a bit each
    std::array<Vec3<R>, block_nodes> axis{};           ///< the collider's normal, along which alone sticking nodes move
    std::array<std::uint16_t, block_nodes> held_by{};  ///< the entry of Obstacles::at that holds it
    std::array<R, block_nodes> open_fraction{};        ///< the part of a node's kernel that no collider takes
    // State of its nodes, found anew in each call.
    bool idle = false;                        ///< true if there is no matter at all
    bool has_matter = false;                  ///< true if there is matter at any point of its nodes
    bool counts = false;                      ///< true if any point may change the block, or matters to others
    bool moves = false;                       ///< true if the collider of any of its points does
    R max_speed2 = R(0);                      ///< the square of their largest speed before contact [m^2/s^2],
                                              ///< relative to the colliders
    std::array<Node<R>, block_nodes> facing;  ///< sums over points: normal times area, and area [dx^2]
    std::array<R, block_nodes> most;          ///< area of the largest point [dx^2]
    std::array<std::uint16_t, block_nodes> collider{};  ///< collider of the largest point
    std::array<Vec3<R>, block_nodes> velocity_before;   ///< velocity before contact [m/s]
    std::array<Vec3<R>, block_nodes> surface_velocity;  ///< of colliders at the node's place [m/s]; 0 away from them
  };

  /// Entry `l` of point_nodes() is node in_stencil()[l] of its point's stencil, z fastest.
  const std::vector<ContactPoint>& points() const { return points_; }
  const std::vector<PointNode>& point_nodes() const { return point_nodes_; }
  const std::vector<std::uint8_t>& in_stencil() const { return in_stencil_; }
  const std::vector<PointBlock>& point_blocks() const { return point_blocks_; }
  const std::vector<NodeBlock>& node_blocks() const { return node_blocks_; }
  /// The number of a grid block among node_blocks(), or -1.
  std::int32_t node_block_of_block(std::size_t block) const { return changes(block) ? node_block_index_[block] : -1; }
  /// True if any collider moves.
  bool moves() const { return any_moves_; }
  /// True of a rigid ball, which pressure cannot turn.
  bool is_free_ball(std::size_t collider) const { return is_free_ball_[collider]; }

 private:
  /// Puts the points that there are aside.
  void keep_points(const BlockList& grid);
  void find_points(const World<R>& world, const Obstacles& obstacles);
  /// Finds the surface points of one block: those kept from before, where there are any, else new
  /// ones.
  void find_points(const World<R>& world, const Obstacles& obstacles, PointBlock& point_block);
  void take_points(const PointBlock& known, PointBlock& point_block);
  void find_points(const World<R>& world, const std::vector<SurfacePoint>& surface, PointBlock& point_block);
  void find_node_blocks(const World<R>& world, const Obstacles& obstacles);
  void transpose(const Obstacles& obstacles);
  NodeBlock& node_block_around(const PointBlock& point_block, std::size_t side) {
    return node_blocks_[static_cast<std::size_t>(
        node_block_index_[static_cast<std::size_t>(point_block.around[side])])];
  }
  /// The velocities of colliders, everywhere,
  void set_all_velocities(const World<R>& world, const Obstacles& obstacles);
  /// at the nodes of a block's points,
  void set_point_velocities(const World<R>& world, const Obstacles& obstacles, PointBlock& point_block);
  /// and at nodes within them that matter sticks to.
  void set_held_velocities(const Obstacles& obstacles, NodeBlock& node_block);
  void find_edge_limiters(const Obstacles& obstacles, const PointBlock& point_block);
  /// Calls body(node block) for those that points of a block may reach.
  template <class Body>
  void for_node_blocks_around(const PointBlock& point_block, const Body& body);
  /// Sets the number of iterations: more near rigid bodies; elsewhere these would cost as much for
  /// nothing.
  void set_iterations();
  NodeBlock& node_block_of(std::uint32_t node) {
    return node_blocks_[static_cast<std::size_t>(node_block_index_[node / block_nodes])];
  }
  /// The part of a node's velocity relative to the collider that sticking leaves free.
  static Vec3<R> free_part(const NodeBlock& node_block, std::size_t n, const Vec3<R>& v) {
    return node_block.sticking >> n & 1 ? node_block.axis[n] * dot(v, node_block.axis[n]) : v;
  }
  // In the order of a call.
  /// Of at most four points.
  void find_masses(const std::array<std::size_t, 4>& which, std::size_t count, const Nodes<R>& nodes,
                   std::array<R, 4>& masses) const;
  /// The masses at points, how fast matter may come nearer, and which points act: where matter may
  /// come nearer than it can in a step, the impulse stays 0. `found`: by grid block, with its mass;
  /// `gaps`: null for matter that has none.
  void find_acting_points(const World<R>& world, const Obstacles& obstacles, const ContactGaps* gaps,
                          PointBlock& point_block, const Nodes<R>& nodes, const std::vector<BlockStats>& found,
                          R per_dt);
  void find_node_areas(NodeBlock& node_block, Nodes<R>& nodes);
  void add_node_areas(NodeBlock& node_block, const Node<R>* own);
  void find_effective_masses(const PointBlock& point_block, const Nodes<R>& nodes);
  void gradient_step(const World<R>& world, const PointBlock& point_block, const Nodes<R>& nodes, R per_dt,
                     const Vec3<R>& gravity_kick, int step, int last);
  /// The velocities at points `first`, `first + 1`, ... before `end` that act: of the next four of
  /// them, whose numbers go to `which`. Returns how many there are.
  std::size_t velocities_at(std::size_t& first, std::size_t end, const Nodes<R>& nodes,
                            std::array<std::size_t, 4>& which, std::array<Node<R>, 4>& sums) const;
  void apply_impulses(const NodeBlock& node_block, Nodes<R>& nodes) const;
  /// Ends the iterations of a point block: sets the impulse before its last one to the last one.
  void rest(const PointBlock& point_block);
  void solve_bodies();
  void apply_friction(const World<R>& world, const NodeBlock& node_block, Nodes<R>& nodes, int last) const;
  void clamp_speeds(const NodeBlock& node_block, Nodes<R>& nodes) const;
  void record_reactions(const World<R>& world, const NodeBlock& node_block, const Nodes<R>& nodes, bool frictional,
                        BlockStats& found) const;

  /// Places for the nodes of a point in the lists below; most need all.
  static constexpr std::size_t stencil_nodes = 27;

  std::vector<PointBlock> point_blocks_;
  std::vector<ContactPoint> points_;       ///< by point block
  std::vector<ActingPoint> acting_;        ///< as points_
  std::vector<PointNode> point_nodes_;     ///< by point
  std::vector<std::uint8_t> in_stencil_;   ///< as point_nodes_: which of the 27 nodes of its point it is, z fastest
  std::vector<std::uint32_t> transposed_;  ///< as point_nodes_: where in node_points_ it is
  std::vector<std::int32_t> point_block_index_;  ///< by grid block, or -1
  /// The same of the call of `prepare` before, and the blocks of its grid.
  struct Before {
    std::vector<std::int32_t> of_block;  ///< empty where the grid had other blocks
    std::vector<PointBlock> blocks;
    std::vector<ContactPoint> points;
    std::vector<PointNode> nodes;
    std::vector<std::uint8_t> in_stencil;
    std::vector<Vec3i> grid;
  } before_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<NodePoint> node_points_;  ///< by node block, then as points_
  /// Entries of a node block whose points are in one point block.
  struct Run {
    std::size_t begin, end;
    std::uint32_t point_block;
  };
  std::vector<Run> runs_;               ///< by node block, 27 each at most
  std::vector<LiveNode> live_nodes_;    ///< as point_nodes_
  std::vector<LivePoint> live_points_;  ///< as node_points_
  /// Impulses of points in the last step [kg m/s]; the fourth number is 0: loads of four at once
  /// are quick.
  std::vector<Node<R>> impulse_changes_;
  /// The velocity of a collider at the place of a node in the stencil of its point [m/s]; empty
  /// while all colliders are at rest.
  std::vector<Vec3<R>> point_node_velocity_;    ///< as point_nodes_
  std::vector<Vec3<R>> node_point_velocity_;    ///< as node_points_
  std::vector<std::int32_t> node_block_index_;  ///< by grid block, or -1
  /// A point of a rigid body.
  struct BodyPoint {
    std::uint32_t point;
    BodyCoupling::Lever lever;
  };
  std::vector<BodyPoint> body_points_;
  std::vector<Vec3<R>> point_node_arm_;  ///< m: of a body's nodes from its center; as point_nodes_, or empty
  BodyCoupling bodies_;
  bool any_moves_ = false;          ///< true if any collider does
  std::vector<bool> is_free_ball_;  ///< by collider: a rigid ball, which pressure cannot turn
  R max_speed2_ = R(0);             ///< of all node blocks
};

}  // namespace dreampm
