// The visit of the grid's nodes on a device: momentum to velocity, the walls of the box, and sums.
// backend/node_terms.h says what happens to a node; the order is that of GridUpdate.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/add_up.h"
#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/visit_sums.h"
#include "dreampm/backend/node_terms.h"

namespace dreampm::gpu {

/// The fields of the grid; null where the world has none.
struct GridPointers {
  Node<float>* field[2];
  Node<float>* velocity_old[2];
  Node<float>* mixture;
};

/// Adds up body(field, thread) over the fields of the grid and the threads of a block into the
/// first of `sums`.
template <int threads, class Block, class Body>
DM_FN void add_up_fields(const GridPointers& grid, Block& block, ImpulseTerms<float>* sums, const Body& body) {
  block.each_thread([&](int t) {
    sums[t] = ImpulseTerms<float>::none();
    for (int f = 0; f < 2 && grid.field[f]; ++f) sums[t].add(body(f, t));
  });
  add_up_threads<threads>(block, sums);
}

/// Where nodes lie in the scene, as World::node_position.
struct NodePlaces {
  Vec3d origin;
  double dx;
  Vec3i low;

  DM_FN Vec3d of(const Vec3i& node) const { return origin + static_cast<Vec3d>(node - low) * dx; }
  /// About the scene's origin, of sums with places in cells from `first` on.
  DM_FN SourceTerms about_origin(const ImpulseTerms<float>& sum, const Vec3i& first) const {
    const ImpulseSumOf<float> own = sum.sum();
    const ImpulseSumOf<double> all{static_cast<Vec3d>(own.impulse), static_cast<Vec3d>(own.angular),
                                   static_cast<double>(own.work)};
    return SourceTerms::of(all.from_cells(of(first), dx), static_cast<double>(sum.gained));
  }
};

/// The gaps before walls, as ContactGaps; for fields without gaps null.
struct GapPointers {
  const std::int32_t* walls_of;  ///< six a block of the grid: its numbers of walls by side, or -1
  const float* gap;              ///< plane_nodes a wall

  /// True if the matter of node `n` of those on a wall touches it.
  DM_FN bool closed(int block, int side, int n) const {
    const std::int32_t wall = walls_of[6 * block + side];
    return wall >= 0 && !(gap[wall * plane_nodes + n] > 0);
  }
  /// The speed at which matter at that node may come nearer to the wall [m/s].
  DM_FN float approach(int block, int side, int n, float per_dt) const {
    const std::int32_t wall = walls_of[6 * block + side];
    return wall < 0 ? 0 : gap[wall * plane_nodes + n] * per_dt;
  }
};

/// A block of the grid in a visit.
struct VisitBlock {
  Vec3i first;           ///< its first node
  std::uint32_t walls;   ///< the sides whose walls it has nodes on or behind, a bit each
  bool waits;            ///< whether images or surfaces may change its nodes before the walls act
  std::int32_t entries;  ///< six times its number among the blocks at walls; -1 of others
};

/// What all kernels of a visit know.
struct VisitInput {
  NodeConstants<float> step;
  float unweigh[2];  ///< by field, as normalize_old_velocity
  /// kg, by field: lighter nodes do not count for the largest speed. No particle sees them with a
  /// weight above a millionth, and their velocity is rounded.
  float light[2];
  GridPointers grid;
  NodePlaces places;
  GapPointers gaps[2];  ///< by field
  const VisitBlock* blocks;
  const std::int32_t* entries;  ///< by side, see VisitBlock: the place in `given`, or -1
  GridTerms* sums;              ///< by block of the grid
  SourceTerms* given;           ///< impulses of walls
  SourceTerms* damped;          ///< impulses of damping, by block; null without damping
  bool all_wait;                ///< whether all blocks wait, as VisitBlock::waits

  DM_FN float speed2_of(const Node<float>& node) const { return dot(velocity(node), velocity(node)); }
};

/// The number of a node of a block among those of its plane across an axis, as node_in_plane.
DM_FN int in_plane(int axis, const Vec3i& at) { return at[(axis + 1) % 3] * block_width + at[(axis + 2) % 3]; }

/// Contact of a block with the walls, and its sums; common to the kernels below.
struct BlockBoundaries {
  static constexpr int threads = block_nodes;
  struct Shared {
    NodeTerms<float> terms[threads];
    ImpulseTerms<float> given[threads];
    ImpulseTerms<float> walls[6];
    GridTerms sum;
  };

  /// `shared.sum`: what is known of block `b`, which goes to memory with the rest.
  template <class Block>
  static DM_FN void finish(const VisitInput& in, Block& block, Shared& shared, int b) {
    const VisitBlock at = in.blocks[b];
    block.each_thread([&](int t) {
      if (t < 6) shared.walls[t] = ImpulseTerms<float>::none();
      shared.terms[t] = NodeTerms<float>::none();
    });
    if (shared.sum.mass > 0)
      for (int f = 0; f < 2; ++f)
        if (in.grid.field[f]) meet_walls(in, block, shared, b, f);
    block.each_thread([&](int t) {
      if (t < 6 && at.entries >= 0)
        if (const std::int32_t entry = in.entries[at.entries + t]; entry >= 0)
          in.given[entry] = in.places.about_origin(shared.walls[t], at.first);
      if (t != 0) return;
      GridTerms sum = shared.sum;
      sum.add(shared.terms[0]);
      sum.finite = sum.finite && sum.kinetic2 - sum.kinetic2 == 0 && sum.fastest2 < 1e30;
      in.sums[b] = sum;
    });
  }

 private:
  template <class Block>
  static DM_FN void meet_walls(const VisitInput& in, Block& block, Shared& shared, int b, int f) {
    Node<float>* const nodes = in.grid.field[f] + std::int64_t{b} * block_nodes;
    const VisitBlock at = in.blocks[b];
    const BoxWalls<float> felt = in.step.walls[f].from(at.first);
    const auto take = [&](int side) {
      add_up_threads<threads>(block, shared.given);
      block.each_thread([&](int t) {
        if (t == 0) shared.walls[side].add(shared.given[0]);
      });
    };
    for (int side = 0; side < 6; ++side) {
      if (!(at.walls >> side & 1)) continue;
      block.each_thread([&](int t) { shared.given[t] = meet(in, felt, side, b, f, t, nodes[t]); });
      take(side);
    }
    for (int side = 0; in.step.skin && f == 0 && side < 6; ++side) {
      if (!(at.walls >> side & 1) || !in.step.slows[side]) continue;
      block.each_thread([&](int t) {
        const float viscosity = mixture::viscosity(in.grid.mixture[std::int64_t{b} * block_nodes + t]);
        shared.given[t] = slow(in, side, at.first + node_offset(t), viscosity, t, nodes[t]);
      });
      take(side);
    }
    block.each_thread([&](int t) {
      const float speed2 = in.speed2_of(nodes[t]);
      NodeTerms<float> own = NodeTerms<float>::none();
      own.kinetic2 = nodes[t].m * speed2;
      own.fastest2 = nodes[t].m < in.light[f] ? 0 : speed2;
      if (f == 0) shared.terms[t] = own;
      if (f == 1) shared.terms[t].add(own);
    });
    if (f == 1 || !in.grid.field[1]) add_up_threads<threads>(block, shared.terms);
  }
  static DM_FN ImpulseTerms<float> meet(const VisitInput& in, const BoxWalls<float>& felt, int side, int b, int f,
                                        int n, Node<float>& node) {
    const Vec3i at = node_offset(n);
    const Vec3<float> place = static_cast<Vec3<float>>(at), before = velocity(node);
    ImpulseSumOf<float> given;
    if (felt.holds(side, place)) {
      const bool gapped = in.gaps[f].walls_of != nullptr;
      const float approach = gapped ? in.gaps[f].approach(b, side, in_plane(axis_of(side), at), in.step.per_dt) : 0.0f;
      const WallContact<float> met = wall_contact<float>(felt, side, before, gapped ? &approach : nullptr);
      set_velocity(node, met.after);
      given.add(place, node.m, before, met.after, met.stopped);
    }
    return ImpulseTerms<float>::of(given);
  }
  static DM_FN ImpulseTerms<float> slow(const VisitInput& in, int side, const Vec3i& at, float viscosity, int n,
                                        Node<float>& node) {
    ImpulseSumOf<float> given;
    BoundaryLayer<float> layer;
    if (has_mass(node) && boundary_layer(in.step, side, at, node, viscosity, layer)) {
      const Vec3<float> before = velocity(node), after = after_layer(in.step, before, layer);
      set_velocity(node, after);
      given.add(static_cast<Vec3<float>>(node_offset(n)), node.m, before, after, after);
    }
    return ImpulseTerms<float>::of(given);
  }
};

/// Momentum to velocity; contact with walls too, where the block does not wait. A block of threads
/// takes a block of the grid.
struct BeginVisit {
  static constexpr int threads = block_nodes;
  using Shared = BlockBoundaries::Shared;
  VisitInput in;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    const VisitBlock at = in.blocks[b];
    block.each_thread([&](int t) {
      ImpulseSumOf<float> damped;
      shared.terms[t] = convert(std::int64_t{b} * block_nodes + t, t, damped);
      shared.given[t] = ImpulseTerms<float>::of(damped);
    });
    add_up_threads<threads>(block, shared.terms);
    if (in.damped) add_up_threads<threads>(block, shared.given);
    block.each_thread([&](int t) {
      if (t != 0) return;
      if (in.damped) in.damped[b] = in.places.about_origin(shared.given[0], at.first);
      GridTerms sum = GridTerms::none();
      sum.add(shared.terms[0]);
      const Vec3d first = in.places.of(at.first);
      for (int a = 0; a < 3; ++a) sum.moment[a] = first[a] * sum.mass + sum.moment[a] * in.places.dx;
      sum.finite = sum.finite && sum.mass - sum.mass == 0;
      shared.sum = in.sums[b] = sum;
    });
    if (!at.waits && !in.all_wait) BlockBoundaries::finish(in, block, shared, b);
  }

 private:
  DM_FN NodeTerms<float> convert(std::int64_t at, int n, ImpulseSumOf<float>& damped) const {
    NodeTerms<float> sum = NodeTerms<float>::none();
    const Vec3<float> place = static_cast<Vec3<float>>(node_offset(n));
    for (int f = 0; f < 2; ++f) {
      if (!in.grid.field[f]) continue;
      if (Node<float>* const old = in.grid.velocity_old[f]) {
        Node<float> before = old[at];
        sum.arrived2 += normalize_old_velocity(before, in.unweigh[f]);
        old[at] = before;
      }
      Node<float> node = in.grid.field[f][at];
      const Vec3<float> q = velocity(node);
      if (in.damped && has_mass(node)) {
        const Vec3<float> v = q * (1 / node.m), kept = v * in.step.keep;
        damped.add(place, node.m, v, kept, (v + kept) * 0.5f);
      }
      set_velocity(node, node_velocity(q, node.m, in.step.keep, in.step.kick));
      in.grid.field[f][at] = node;
      sum.mass += node.m;
      for (int a = 0; a < 3; ++a) sum.moment[a] += place[a] * node.m;
      // A mass that is no number stays in the sum.
      sum.finite = sum.finite && !(node.m < 0);
    }
    return sum;
  }
};

/// Contact with walls of the blocks that waited.
struct FinishVisit {
  static constexpr int threads = block_nodes;
  using Shared = BlockBoundaries::Shared;
  VisitInput in;
  const std::uint32_t* waiting;  ///< blocks of the grid; null: all

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = waiting ? static_cast<int>(waiting[block.index()]) : block.index();
    block.each_thread([&](int t) {
      if (t == 0) shared.sum = in.sums[b];
    });
    BlockBoundaries::finish(in, block, shared, b);
  }
};

}  // namespace dreampm::gpu
