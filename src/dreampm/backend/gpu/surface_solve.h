// Contact at points of colliders' surfaces on a device: the kernels of backend/surface_contact.h,
// for colliders whose motion is known. Points read nodes and nodes read points, so that no two
// threads write the same number, and the bits do not depend on their order.
#pragma once
#include <bit>
#include <cstdint>

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
