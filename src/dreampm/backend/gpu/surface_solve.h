// Contact at points of colliders' surfaces on a device: the kernels of backend/surface_contact.h,
// for colliders whose motion is known. Points read nodes and nodes read points, so that no two
// threads write the same number, and the bits do not depend on their order.
#pragma once
#include <bit>
#include <cstdint>

#include "dreampm/backend/gpu/contact_gaps.h"
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
  float area;                  ///< dx^2
  std::uint32_t block;         ///< its number among the blocks with points
  std::uint32_t deep;          ///< nodes of its stencil that take no part, a bit each
  std::int32_t limiter;        ///< the point that limits its impulse at an edge, or -1
  std::int8_t first[3];        ///< node of its stencil
  bool limits;                 ///< whether it limits another one
  std::uint16_t collider;

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
  double sticky;  ///< Pa
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
  std::int32_t* fastest2;  ///< less the bits of the square of the largest speed
  SourceTerms* given;      ///< by entry of groups

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

/// The masses at points, how fast matter may come nearer, and which points act. A thread takes a
/// point.
struct FindActingPoints {
  static constexpr int threads = 128;
  struct Shared {};
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const std::int32_t i = block.index() * threads + t;
      if (i == 0) *all.fastest2 = 0;
      if (i >= all.count) return;
      const ContactPoint& p = all.points[i];
      const CollidingMatter collider = all.colliders[p.collider];
      PointState state{true, 0, 0, 0, 0, 0, {0, 0}};
      if (all.gaps && collider.gapped) {
        const float gap = gap_at(p);
        state.approach = gap * all.per_dt;
        state.acts = gap < all.no_gap || collider.type != WallType::separate || collider.sticky > 0;
      }
      if (state.acts || p.limits) {
        float mass = 0;
        PointWeights(p).each(all, p, [&](int, const Vec3i&, float w, std::int64_t n) { mass += w * all.node(n).m; });
        state.mass = mass > static_cast<float>(least_mass) ? mass : 0;
      }
      state.acts = state.acts && state.mass > 0;
      all.point_states[i] = state;
      all.changes[i] = {0, 0, 0};
    });
  }

 private:
  /// As ContactGaps::AtPoints.
  DM_FN float gap_at(const ContactPoint& p) const {
    float gap = all.no_gap;
    for (int side = 0; side < 6; ++side) {
      if (!turned_like(p.normal, side)) continue;
      for (int m = 0; m < 27; ++m) {
        const Vec3i node = p.node(m) - Vec3i{1, 1, 1};
        const std::int32_t slot = all.blocks[p.block].gaps[block_around(node)];
        if (slot < 0) continue;
        gap = min(gap,
                  std::bit_cast<float>(
                      all.gaps[std::int64_t{slot} * block_gaps + side * block_nodes + SurfaceInput::in_block(node)]));
      }
    }
    return gap;
  }
};

/// What points are at each node: how they face, and what they allow it. A block of threads takes a
/// block of nodes.
struct FindNodeAreas {
  static constexpr int threads = block_nodes;
  struct Shared {
    float fastest2[threads];
  };
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    block.each_thread([&](int t) { shared.fastest2[t] = look_at(std::int64_t{block.index()} * block_nodes + t); });
    block.each_thread([&](int t) {
      if (t != 0) return;
      float most = 0;
      for (int i = 0; i < threads; ++i) most = max(shared.fastest2[i], most);
      // The bits of such floats order like whole numbers.
      Block::lower(*all.fastest2, -std::bit_cast<std::int32_t>(most));
    });
  }

 private:
  /// Returns the square of the node's speed beside that of the surface.
  DM_FN float look_at(std::int64_t number) const {
    const ContactNode at = all.nodes[number];
    Node<float>& node = all.node(number);
    const float mass = mass_or_none(node);
    NodeState state{{0, 0, 0, 0}, velocity(node), at.sticks ? at.velocity : Vec3<float>{0, 0, 0}, at.collider};
    float most = 0;
    for (std::uint32_t i = all.first[number]; i < all.first[number + 1]; ++i) {
      const PointOfNode of = all.points_of[i];
      all.inverse_masses[i] = 0;
      const PointState& point = all.point_states[of.point];
      if (!point.acts) continue;
      const ContactPoint& p = all.points[of.point];
      const float inverse_mass = bounded_inverse_mass(PointWeights(p).at(of.m), mass, at.open_fraction, point.mass);
      all.inverse_masses[i] = inverse_mass;
      const float area = p.area * inverse_mass * mass;
      state.facing = state.facing + Node<float>{p.normal.x, p.normal.y, p.normal.z, 1} * area;
      if (all.moves && !at.sticks)
        state.surface += p.velocity_at(p.node(of.m), static_cast<float>(all.in.places.dx)) * area;
      if (area > most) most = area, state.collider = p.collider;
    }
    // The mean over the points at a node, by their areas.
    if (all.moves && !at.sticks && state.facing.m > 0) state.surface = state.surface * (1 / state.facing.m);
    all.node_states[number] = state;
    const Vec3<float> relative = state.before - state.surface;
    set_velocity(node, SurfaceInput::free_part(at, relative) + state.surface);
    return mass > 0 ? dot(relative, relative) : 0;
  }
};

/// The impulse per velocity of points. A thread takes a point.
struct FindEffectiveMasses {
  static constexpr int threads = 128;
  struct Shared {};
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const std::int32_t i = block.index() * threads + t;
      if (i >= all.count) return;
      PointState& state = all.point_states[i];
      const ContactPoint& p = all.points[i];
      if (!state.acts && !(state.mass > 0 && p.limits)) return;
      float held = 0, row = 0;
      Vec3<float> surface{0, 0, 0};
      float* const weights = all.velocity_weights + 27 * std::int64_t{i};
      for (int m = 0; m < 27; ++m) weights[m] = 0;
      PointWeights(p).each(all, p, [&](int m, const Vec3i& place, float w, std::int64_t n) {
        const float mass = mass_or_none(all.node(n));
        const float inverse_mass = bounded_inverse_mass(w, mass, all.nodes[n].open_fraction, state.mass);
        weights[m] = inverse_mass * mass;
        held += weights[m];
        if (all.moves) surface += p.velocity_at(place, static_cast<float>(all.in.places.dx)) * weights[m];
        row += inverse_mass * all.node_states[n].facing.m;
      });
      state.effective_mass = effective_mass_of(held, row, state.acts);
      state.surface_speed = dot(surface, p.normal);
    });
  }
};

/// A step of the descent at all points. A thread takes a point.
struct DescendPoints {
  static constexpr int threads = 128;
  struct Shared {};
  SurfaceInput all;
  int step, last;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const std::int32_t i = block.index() * threads + t;
      if (i >= all.count) return;
      PointState state = all.point_states[i];
      if (!state.acts || !(state.effective_mass > 0)) return;
      const ContactPoint& p = all.points[i];
      const CollidingMatter collider = all.colliders[p.collider];
      const float* const weights = all.velocity_weights + 27 * std::int64_t{i};
      Vec3<float> v{0, 0, 0};
      PointWeights(p).each(
          all, p, [&](int m, const Vec3i&, float, std::int64_t n) { v += velocity(all.node(n)) * weights[m]; });
      float now =
          descended(state.extrapolated, dot(v, p.normal) - state.surface_speed, state.effective_mass, state.approach,
                    collider.type == WallType::separate, least_impulse(collider.sticky, all.in.places.dx, all.per_dt));
      const int now_at = step & 1, before_at = 1 - now_at;
      if (step > 0 && p.limiter >= 0) {
        const PointState& limiter = all.point_states[p.limiter];
        if (limiter.effective_mass > 0)
          now = limited_at_edge(now, limiter.impulse[before_at], p.from_edge, state.mass, all.gravity_kick);
      }
      const float extrapolated = now + (now - state.impulse[before_at]) * momentum_of_descent<float>(step, last);
      all.changes[i] = p.normal * ((extrapolated - state.extrapolated) * p.area);
      all.point_states[i].impulse[now_at] = now;
      all.point_states[i].extrapolated = extrapolated;
    });
  }
};

/// What that gives to the nodes. A thread takes a node.
struct ApplyImpulses {
  static constexpr int threads = block_nodes;
  struct Shared {};
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const std::int64_t number = std::int64_t{block.index()} * block_nodes + t;
      if (!(all.node_states[number].facing.m > 0)) return;
      Vec3<float> change{0, 0, 0};
      for (std::uint32_t i = all.first[number]; i < all.first[number + 1]; ++i)
        if (const float inverse_mass = all.inverse_masses[i]; inverse_mass > 0)
          change += all.changes[all.points_of[i].point] * inverse_mass;
      Node<float>& node = all.node(number);
      set_velocity(node, velocity(node) + SurfaceInput::free_part(all.nodes[number], change));
    });
  }
};

/// Friction, the bound of speeds, and what the colliders gave. A block of threads takes a block of
/// nodes.
struct FinishSurfaces {
  static constexpr int threads = block_nodes;
  struct Shared {
    ImpulseTerms<float> given[threads];
    std::int32_t collider[threads];
    ImpulseTerms<float> own[threads];
  };
  SurfaceInput all;
  int last;  ///< step

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      const std::int64_t number = std::int64_t{b} * block_nodes + t;
      shared.own[t] = finish(number, t);
      shared.collider[t] = all.node_states[number].collider;
    });
    const Vec3i first = all.in.blocks[all.node_blocks[b]].first;
    for (std::uint32_t g = all.first_group[b]; g < all.first_group[b + 1]; ++g) {
      const SurfaceGroup group = all.groups[g];
      block.each_thread([&](int t) {
        shared.given[t] = shared.collider[t] == group.collider ? shared.own[t] : ImpulseTerms<float>::none();
      });
      add_up_threads<threads>(block, shared.given);
      block.each_thread([&](int t) {
        if (t != 0) return;
        SourceTerms sum = all.field == 0 ? SourceTerms::none() : all.given[group.entry];
        sum.add(all.in.places.about_origin(shared.given[0], first));
        all.given[group.entry] = sum;
      });
    }
  }

 private:
  DM_FN ImpulseTerms<float> finish(std::int64_t number, int n) const {
    const NodeState state = all.node_states[number];
    Node<float>& node = all.node(number);
    Vec3<float> v = velocity(node);
    const Vec3<float> facing{state.facing.x, state.facing.y, state.facing.z};
    if (all.frictional) {
      float most = 0;  // of velocity that friction takes
      for (std::uint32_t i = all.first[number]; i < all.first[number + 1]; ++i)
        if (const float inverse_mass = all.inverse_masses[i]; inverse_mass > 0) {
          const std::uint32_t of = all.points_of[i].point;
          const ContactPoint& p = all.points[of];
          most += all.colliders[p.collider].friction * all.point_states[of].impulse[last & 1] * p.area * inverse_mass;
        }
      v = after_friction(v, state.surface, facing, most);
    }
    if (state.facing.m > 0) {
      // As FindNodeAreas wrote it.
      const auto fastest2 = std::bit_cast<float>(-*all.fastest2);
      v = clamped_speed(v, state.surface, fastest2);
    }
    set_velocity(node, v);
    ImpulseSumOf<float> given;
    if (!(v == state.before))
      given.add(static_cast<Vec3<float>>(node_offset(n)), node.m, state.before, v,
                works_at(v, state.surface, facing, all.frictional));
    return ImpulseTerms<float>::of(given);
  }
};

}  // namespace dreampm::gpu
