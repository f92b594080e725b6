// What a pass keeps of its nodes in the memory of a block of threads: copies from which particles
// gather, and sums to which they add.
#pragma once
#include "dreampm/backend/gpu/arena.h"
#include "dreampm/physics/transfer.h"

namespace dreampm::gpu {

/// Where a pass writes an arena: `arena_nodes` a block of particles.
struct ArenaOutput {
  NodeCounts* counts;  ///< or null
  bool first;          ///< whether this set is the first that writes there; others add
};

/// Sums of one field in the memory of a block of threads.
struct ArenaSums {
  std::int32_t x[arena_room], y[arena_room], z[arena_room], m[arena_room];
};

/// The numbers of a node that a particle adds to, a bit each: others are zero, and adding zeros
/// would cost as much.
enum Components : unsigned { x_part = 1, y_part = 2, z_part = 4, mass_part = 8, vector_part = 7, all_parts = 15 };

/// Adds what a particle gives to a field: q and slopes of `scatter_terms`, and `mass` alike. The
/// sum over its nodes is exactly that of the particle: the middle node, whose weight is the
/// largest, gets what rounding left over. Without that, small weights would round down more often
/// than up.
template <class Block, unsigned parts = all_parts>
DM_FN void scatter_counts(const Stencil<float>& s, const Vec3<float>& q, const Vec3<float> (&slope)[3], float mass,
                          const ScatterUnits& units, ArenaSums& sums) {
  using Quad = Node<float>;
  const Quad whole{q.x * units.momentum, q.y * units.momentum, q.z * units.momentum, mass * units.mass};
  Quad slopes[3];
  for (int a = 0; a < 3; ++a)
    slopes[a] = {slope[a].x * units.momentum, slope[a].y * units.momentum, slope[a].z * units.momentum, 0};
  const auto add = [&sums](int at, const NodeCounts& n) {
    if constexpr (parts & x_part) Block::add(sums.x[at], n.x);
    if constexpr (parts & y_part) Block::add(sums.y[at], n.y);
    if constexpr (parts & z_part) Block::add(sums.z[at], n.z);
    if constexpr (parts & mass_part) Block::add(sums.m[at], n.m);
  };
  const int first = place_in_arena(s.node(0) + 1, s.node(1) + 1, s.node(2) + 1);
  NodeCounts left{Block::nearest(whole.x), Block::nearest(whole.y), Block::nearest(whole.z), Block::nearest(whole.m)};
  scatter_terms(s, whole, slopes, [&](int i, int j, int k, const Quad& term, float w) {
    if (i == 1 && j == 1 && k == 1) return;
    const NodeCounts n{Block::nearest(term.x * w), Block::nearest(term.y * w), Block::nearest(term.z * w),
                       Block::nearest(term.m * w)};
    add(first + place_in_arena(i, j, k), n);
    left = left + -n;
  });
  add(first + place_in_arena(1, 1, 1), left);
}

/// The largest that a particle adds to a node of its own over its weight there and its mass [m/s].
DM_FN float scattered_speed(const Vec3<float>& q, const Vec3<float> (&slope)[3], float mass) {
  float most = 0;
  for (int c = 0; c < 3; ++c)
    most = max(most, abs(q[c]) + 1.5f * (abs(slope[0][c]) + abs(slope[1][c]) + abs(slope[2][c])));
  return most / mass;
}

/// The nodes of a block of particles, which a pass copies to where its threads find them fast.
struct NodeCopy {
  float x[arena_room], y[arena_room], z[arena_room], m[arena_room];
};

/// Thread `t`'s share of the copy; nodes to which no particle can come are zero.
template <int threads>
DM_FN void copy_nodes(int t, const std::int32_t* stencil_blocks, const Node<float>* field, NodeCopy& to) {
  for (int n = t; n < arena_nodes; n += threads) {
    const ArenaNode at(n);
    const std::int32_t b = stencil_blocks[at.corner()];
    const Node<float> node = b < 0 ? Node<float>{} : field[std::int64_t{b} * block_nodes + at.in_block()];
    const int place = at.place();
    to.x[place] = node.x, to.y[place] = node.y, to.z[place] = node.z, to.m[place] = node.m;
  }
}
/// The rows of velocities around a particle, as gather() takes them.
DM_FN auto velocity_rows(const Stencil<float>& s, const NodeCopy& nodes) {
  const int first = place_in_arena(s.node(0) + 1, s.node(1) + 1, s.node(2) + 1);
  return [first, &nodes](int i, int j) {
    NodeRow<Vec3<float>> row;
    for (int k = 0; k < 3; ++k) {
      const int at = first + place_in_arena(i, j, k);
      row.n[k] = {nodes.x[at], nodes.y[at], nodes.z[at]};
    }
    return row;
  };
}

/// Thread `t`'s share.
template <int threads>
DM_FN void clear(int t, ArenaSums& sums) {
  for (int n = t; n < arena_room; n += threads) sums.x[n] = sums.y[n] = sums.z[n] = sums.m[n] = 0;
}
/// What a thread wrote to an arena: its largest count of mass, and the sum of the counts that it
/// added.
struct Written {
  std::uint32_t most;
  std::int64_t counts;
};
/// Thread `t`'s share of what goes to the arena of block `b` of the particles.
template <int threads>
DM_FN Written write(int t, int b, const ArenaSums& sums, const ArenaOutput& to) {
  Written all{0, 0};
  if (!to.counts) return all;
  for (int n = t; n < arena_nodes; n += threads) {
    const int at = ArenaNode(n).place();
    NodeCounts& node = to.counts[std::int64_t{b} * arena_nodes + n];
    NodeCounts count{sums.x[at], sums.y[at], sums.z[at], sums.m[at]};
    // The own count too: with what is there it may run over unseen.
    const auto own = static_cast<std::uint32_t>(count.m);
    all.counts += own;
    if (own > all.most) all.most = own;
    if (!to.first) count = count + node;
    node = count;
    const auto mass = static_cast<std::uint32_t>(count.m);
    if (mass > all.most) all.most = mass;
  }
  return all;
}

/// The same for a set without particles there: zeros where it is the first to write.
template <int threads>
DM_FN void write_zeros(int t, int b, const ArenaOutput& to) {
  if (!to.counts || !to.first) return;
  for (int n = t; n < arena_nodes; n += threads) to.counts[std::int64_t{b} * arena_nodes + n] = {0, 0, 0, 0};
}

}  // namespace dreampm::gpu
