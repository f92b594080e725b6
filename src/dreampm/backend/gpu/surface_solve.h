// Contact at points of colliders' surfaces on a device: the kernels of backend/surface_contact.h.
// The host solves for the velocities of rigid bodies (gpu/surface_solver.h). Points read nodes and
// nodes read points, so that no two threads write the same number, and the bits do not depend on
// their order.
#pragma once
#include <bit>
#include <cstdint>

#include "dreampm/backend/body_sums.h"
#include "dreampm/backend/gpu/contact_gaps.h"
#include "dreampm/backend/gpu/surface_input.h"

namespace dreampm::gpu {

/// The masses at points, how fast matter may come nearer, and which points act. A thread takes a
/// point.
struct FindActingPoints {
  static constexpr int threads = 128;
  struct Shared {};
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      if (block.index() == 0 && t == 0) *all.fastest2 = 0;
    });
    each_item<threads>(block, all.count, [&](std::int64_t i) {
      const ContactPoint& p = all.points[i];
      const CollidingMatter collider = all.colliders[p.collider];
      PointState state{true, 0, 0, 0, 0, 0, {0, 0}, 0, {0, 0, 0}};
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
    if (!(mass > 0)) return 0;
    const Vec3<float> relative = state.before - state.surface;
    set_velocity(node, SurfaceInput::free_part(at, relative) + state.surface);
    return dot(relative, relative);
  }
};

/// The impulse per velocity of points. A thread takes a point.
struct FindEffectiveMasses {
  static constexpr int threads = 128;
  struct Shared {};
  SurfaceInput all;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    each_item<threads>(block, all.count, [&](std::int64_t i) {
      PointState& state = all.point_states[i];
      const ContactPoint& p = all.points[i];
      if (!state.acts && !(state.mass > 0 && p.limits)) return;
      const auto dx = static_cast<float>(all.in.places.dx);
      const bool unknown = all.bodies && p.body >= 0;
      float held = 0, row = 0;
      Vec3<float> surface{0, 0, 0}, arm{0, 0, 0};
      float* const weights = all.velocity_weights + 27 * i;
      for (int m = 0; m < 27; ++m) weights[m] = 0;
      PointWeights(p).each(all, p, [&](int m, const Vec3i& place, float w, std::int64_t n) {
        const float mass = mass_or_none(all.node(n));
        const float inverse_mass = bounded_inverse_mass(w, mass, all.nodes[n].open_fraction, state.mass);
        weights[m] = inverse_mass * mass;
        held += weights[m];
        if (all.moves) surface += p.velocity_at(place, dx) * weights[m];
        if (unknown) arm += (p.arm + (static_cast<Vec3<float>>(place) - p.at) * dx) * weights[m];
        row += inverse_mass * all.node_states[n].facing.m;
      });
      state.effective_mass = effective_mass_of(held, row, state.acts);
      state.surface_speed = dot(surface, p.normal);
      if (unknown) state.held = held, state.turn = all.colliders[p.collider].ball ? state.turn : cross(arm, p.normal);
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
    each_item<threads>(block, all.count, [&](std::int64_t i) {
      PointState state = all.point_states[i];
      const ContactPoint& p = all.points[i];
      if (!state.acts || !(state.effective_mass > 0) || step > p.iterations) return;
      if (step == p.iterations) {  // from here on it stays as it is
        // So others may read the impulse of the last step meanwhile.
        static_assert(ColliderContact::iterations % 2 == 0 && ColliderContact::body_iterations % 2 == 0);
        all.point_states[i].impulse[0] = state.impulse[1];
        all.changes[i] = {0, 0, 0};
        return;
      }
      const CollidingMatter collider = all.colliders[p.collider];
      const float* const weights = all.velocity_weights + 27 * i;
      Vec3<float> v{0, 0, 0};
      PointWeights(p).each(
          all, p, [&](int m, const Vec3i&, float, std::int64_t n) { v += velocity(all.node(n)) * weights[m]; });
      float now = descended(state.extrapolated, dot(v, p.normal) - surface_speed(p, state), state.effective_mass,
                            state.approach, collider.type == WallType::separate,
                            least_impulse(collider.sticky, all.in.places.dx, all.per_dt));
      const int now_at = step & 1, before_at = 1 - now_at;
      if (step > 0 && p.limiter >= 0) {
        const PointState& limiter = all.point_states[p.limiter];
        if (limiter.effective_mass > 0)
          now = limited_at_edge(now, limiter.impulse[before_at], p.from_edge, state.mass, all.gravity_kick);
      }
      const float extrapolated =
          now + (now - state.impulse[before_at]) *
                    momentum_of_descent<float>(step, p.iterations <= last ? p.iterations - 1 : last);
      all.changes[i] = p.normal * ((extrapolated - state.extrapolated) * p.area);
      all.point_states[i].impulse[now_at] = now;
      all.point_states[i].extrapolated = extrapolated;
    });
  }

 private:
  /// Along the normal [m/s].
  DM_FN float surface_speed(const ContactPoint& p, const PointState& state) const {
    if (!all.bodies || p.body < 0) return state.surface_speed;
    const BodyMotion body = all.bodies[p.body];
    return static_cast<float>(dot(static_cast<Vec3d>(p.normal) * static_cast<double>(state.held), body.velocity) +
                              dot(static_cast<Vec3d>(state.turn), body.spin));
  }
};

/// What matter does to rigid bodies. A block of threads takes a range of points.
struct SumBodies {
  static constexpr int threads = 64;
  struct Shared {
    BodySums sums[threads];
  };
  SurfaceInput all;
  const std::uint32_t* points;  ///< of bodies, those of one together
  const Range* ranges;
  BodySums* to;  ///< by range

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const Range range = ranges[block.index()];
    block.each_thread([&](int t) {
      BodySums sums = BodySums::none();
      for (std::uint32_t i = range.begin + static_cast<std::uint32_t>(t); i < range.end; i += threads) {
        const PointState& state = all.point_states[points[i]];
        if (!state.acts || !(state.effective_mass > 0)) continue;
        const ContactPoint& p = all.points[points[i]];
        const double area = static_cast<double>(p.area), impulse = static_cast<double>(state.extrapolated);
        sums.add_point(static_cast<Vec3d>(p.normal) * static_cast<double>(state.held), static_cast<Vec3d>(state.turn),
                       area * impulse, impulse != 0 ? area * static_cast<double>(state.effective_mass) : 0);
      }
      shared.sums[t] = sums;
    });
    add_up_threads<threads>(block, shared.sums);
    block.each_thread([&](int t) {
      if (t == 0) to[block.index()] = shared.sums[0];
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
        sum.add(about_origin(shared.given[0], all.colliders[group.collider], first));
        all.given[group.entry] = sum;
      });
    }
  }

 private:
  /// The impulse of a block. That of a ball goes through its middle.
  DM_FN SourceTerms about_origin(const ImpulseTerms<float>& given, const CollidingMatter& collider,
                                 const Vec3i& first) const {
    SourceTerms sum = all.in.places.about_origin(given, first);
    if (all.frictional || !collider.ball) return sum;
    const Vec3d angular = cross(collider.center, Vec3d{sum.impulse[0], sum.impulse[1], sum.impulse[2]});
    for (int a = 0; a < 3; ++a) sum.angular[a] = angular[a];
    return sum;
  }
  /// Of a node in its block [cells]; of rigid bodies the copy nearest to their center: one at a
  /// periodic end has matter beyond the other.
  DM_FN Vec3<float> place(std::int64_t number, int n, const CollidingMatter& collider) const {
    Vec3<float> at = static_cast<Vec3<float>>(node_offset(n));
    if (!collider.rigid) return at;
    const Vec3d there = all.in.places.of(all.in.blocks[all.node_blocks[number / block_nodes]].first + node_offset(n));
    for (int a = 0; a < 3; ++a)
      if (all.period[a] > 0)
        at[a] -= static_cast<float>(round_int((there[a] - collider.center[a]) / all.period[a]) * all.period[a] /
                                    all.in.places.dx);
    return at;
  }
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
      given.add(place(number, n, all.colliders[state.collider]), node.m, state.before, v,
                works_at(v, state.surface, facing, all.frictional));
    return ImpulseTerms<float>::of(given);
  }
};

}  // namespace dreampm::gpu
