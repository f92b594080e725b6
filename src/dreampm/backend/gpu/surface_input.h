// Contact at points of colliders' surfaces on a device: what its kernels know (surface_solve.h).
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/node_visit.h"
#include "dreampm/backend/solid_normal.h"
#include "dreampm/backend/surface_terms.h"
#include "dreampm/math/bspline.h"

namespace dreampm::gpu {

/// A point of a collider's surface, as SurfacePoint and SurfaceContact::ContactPoint.
struct ContactPoint {
  Vec3<float> at;  ///< cells from its block's first node
  Vec3<float> normal, from_edge;
  Vec3<float> velocity, spin;  ///< m/s and rad/s, of the collider at it
  Vec3<float> arm;             ///< m, from the center of the collider's motion
  float area;                  ///< dx^2
  std::uint32_t block;         ///< its number among the blocks with points
  std::uint32_t deep;          ///< nodes of its stencil that take no part, a bit each
  std::int32_t limiter;        ///< the point that limits its impulse at an edge, or -1
  std::int8_t first[3];        ///< node of its stencil
  bool limits;                 ///< whether it limits another one
  std::uint8_t iterations;     ///< of its impulse in each solve
  std::uint16_t collider;
  std::int32_t body;  ///< the rigid body that it is of, or -1

  DM_FN Vec3i node(int m) const { return {first[0] + m / 9, first[1] + m / 3 % 3, first[2] + m % 3}; }
  /// The velocity of the collider at a node [m/s].
  DM_FN Vec3<float> velocity_at(const Vec3i& node, float dx) const {
    return velocity + cross(spin, (static_cast<Vec3<float>>(node) - at) * dx);
  }
};
/// What lies around a block with points, as Neighbors.
struct PointBlock {
  std::int32_t nodes[27];  ///< numbers among the blocks with nodes of points, or -1
  std::int32_t gaps[27];   ///< numbers of gaps, or -1
};
/// A node in a block with nodes of points.
struct ContactNode {
  float open_fraction;         ///< the part of its kernel that no collider takes
  bool sticks;                 ///< whether it lies inside a collider that matter sticks to
  std::uint16_t collider;      ///< that one
  Vec3<float> axis, velocity;  ///< along which alone it moves then, beside that velocity [m/s]
};
/// A point at a node.
struct PointOfNode {
  std::uint32_t point;
  std::int32_t m;  ///< which node of the point's stencil it is, z fastest
};
/// How a collider meets matter of one field.
struct CollidingMatter {
  WallType type;
  bool gapped;  ///< whether matter may come nearer where it has a gap
  float friction;
  double sticky;     ///< Pa
  bool rigid, ball;  ///< whether it is a rigid body, and one that pressure cannot turn
  Vec3d center;      ///< m, of its motion
};
/// How a rigid body moves [m/s, rad/s].
struct BodyMotion {
  Vec3d velocity, spin;
};
/// What a block with nodes of points may receive from one collider.
struct SurfaceGroup {
  std::int32_t collider;
  std::uint32_t entry;
};

/// Unknowns of a point in one solve.
struct PointState {
  bool acts;
  float mass, effective_mass, surface_speed, approach, extrapolated, impulse[2];
  float held;        ///< of a rigid body's: its speed along the normal per velocity of the body [1]
  Vec3<float> turn;  ///< and per spin [m]
};
/// And of a node.
struct NodeState {
  Node<float> facing;
  Vec3<float> before, surface;
  std::int32_t collider;
};

/// What all kernels of a solve know.
struct SurfaceInput {
  VisitInput in;
  int field;
  bool frictional, moves;
  float per_dt;              ///< dx/dt [m/s]
  Vec3<float> gravity_kick;  ///< m/s
  const ContactPoint* points;
  std::int32_t count;
  const PointBlock* blocks;          ///< with points
  const std::uint32_t* node_blocks;  ///< blocks of the grid with nodes of points
  const ContactNode* nodes;          ///< block_nodes each
  const std::uint32_t* first;        ///< by such a node, into `points_of`, and the end
  const PointOfNode* points_of;
  const CollidingMatter* colliders;
  const std::uint32_t* first_group;  ///< by block with nodes, into `groups`, and the end
  const SurfaceGroup* groups;
  const std::int32_t* gaps;  ///< as GapInput; null where matter has none
  float no_gap;              ///< cells: that where no matter is near
  PointState* point_states;
  Vec3<float>* changes;     ///< impulses of points in the last step [kg m/s]
  float* velocity_weights;  ///< 27 a point: of a node's velocity in that of the point [1]
  float* inverse_masses;    ///< as points_of: velocity of the node per impulse [1/kg]
  NodeState* node_states;
  std::int32_t* fastest2;    ///< less the bits of the square of the largest speed
  SourceTerms* given;        ///< by entry of groups
  const BodyMotion* bodies;  ///< where they are unknowns, else null
  Vec3d period;              ///< m, of periodic axes; 0 of others

  /// The number of a node in the grid, and the node.
  DM_FN std::int64_t in_grid(std::int64_t number) const {
    return std::int64_t{node_blocks[number / block_nodes]} * block_nodes + number % block_nodes;
  }
  DM_FN Node<float>& node(std::int64_t number) const { return in.grid.field[field][in_grid(number)]; }
  static DM_FN int in_block(const Vec3i& node) {
    constexpr int last = block_width - 1;
    return node_index(node.x & last, node.y & last, node.z & last);
  }
  /// Of a velocity beside the surface what a node may have: of one that sticks that along its axis.
  static DM_FN Vec3<float> free_part(const ContactNode& at, const Vec3<float>& v) {
    return at.sticks ? at.axis * dot(v, at.axis) : v;
  }
};

/// The weights of a point at its nodes.
struct PointWeights {
  Weights1<float> along[3];
  explicit DM_FN PointWeights(const ContactPoint& p) {
    for (int a = 0; a < 3; ++a) along[a] = bspline2(p.at[a] - static_cast<float>(p.first[a] + 1));
  }
  DM_FN float at(int m) const { return along[0].w[m / 9] * along[1].w[m / 3 % 3] * along[2].w[m % 3]; }
  /// Calls body(m, node, weight, number of the node) for those that take part.
  template <class Body>
  DM_FN void each(const SurfaceInput& all, const ContactPoint& p, const Body& body) const {
    for (int m = 0; m < 27; ++m) {
      const Vec3i node = p.node(m);
      const std::int32_t holder = all.blocks[p.block].nodes[block_around(node)];
      const float w = at(m);
      if (p.deep >> m & 1 || !(w > 0) || holder < 0) continue;
      body(m, node, w, std::int64_t{holder} * block_nodes + SurfaceInput::in_block(node));
    }
  }
};

}  // namespace dreampm::gpu
