// One pass over the particles of a set on a device: gather, law, move, scatter. A block of threads
// takes a block of particles; physics/particle.h says what happens to one.
#pragma once
#include "dreampm/backend/gpu/arena.h"
#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/pass_sums.h"
#include "dreampm/backend/pass_limits.h"
#include "dreampm/physics/divergence.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/particle.h"

namespace dreampm::gpu {

/// The columns of a set in a device's memory, one number a particle each.
struct ParticleColumns {
  float* u[3];
  float* own_velocity[3];  ///< null unless the set keeps velocities
  float* state[most_state_columns];
};

/// Where the particles of a set lie, and what they gather from.
struct PassInput {
  ParticleColumns particles;
  const std::uint32_t* block_start;    ///< by block of particles, and the end
  const std::int32_t* stencil_blocks;  ///< eight a block of particles, as StencilBlocks
  const BlockWalls<float>* walls;      ///< by block of particles
  const BlockLoad* loads;              ///< by block of particles
  const Node<float>* field;            ///< velocities and masses of the set's field
  const Node<float>* velocity_old;     ///< velocities before the forces; null unless the set keeps velocities
  const Node<float>* mixture;          ///< or null
  const Node<float>* clearance;        ///< of colliders, or null
  /// Columns of the gradient of the distance from colliders, and of that distance [cells], or null.
  /// They stand in place of the clearance where they are below `no_distance`.
  const float* distance[4];
};

/// What particles become and what they give to their nodes.
struct PassOutput {
  ParticleColumns particles;
  // Arenas: `arena_nodes` a block of particles, each with whether this set is the first that writes
  // there; others add.
  struct Arena {
    NodeCounts* counts;  ///< or null
    bool first;
  };
  Arena field, velocity_old, stress, mixture;
  BlockSums* sums;  ///< by block of particles
  // Columns for output, as in Motion, or null.
  float *velocity, *gradient, *energy, *volume_ratio;
};

/// Sums of one field in the memory of a block of threads.
struct ArenaSums {
  std::int32_t x[arena_room], y[arena_room], z[arena_room], m[arena_room];
};

/// Adds what a particle gives to a field: q and slopes of `scatter_terms`, and `mass` alike. The
/// sum over its nodes is exactly that of the particle: the middle node, whose weight is the
/// largest, gets what rounding left over. Without that, small weights would round down more often
/// than up.
template <class Block>
DM_FN void scatter_counts(const Stencil<float>& s, const Vec3<float>& q, const Vec3<float> (&slope)[3], float mass,
                          const ScatterUnits& units, ArenaSums& sums) {
  using Quad = Node<float>;
  const Quad whole{q.x * units.momentum, q.y * units.momentum, q.z * units.momentum, mass * units.mass};
  Quad slopes[3];
  for (int a = 0; a < 3; ++a)
    slopes[a] = {slope[a].x * units.momentum, slope[a].y * units.momentum, slope[a].z * units.momentum, 0};
  const int first = place_in_arena(s.node(0) + 1, s.node(1) + 1, s.node(2) + 1);
  NodeCounts left{Block::nearest(whole.x), Block::nearest(whole.y), Block::nearest(whole.z), Block::nearest(whole.m)};
  scatter_terms(s, whole, slopes, [&](int i, int j, int k, const Quad& term, float w) {
    if (i == 1 && j == 1 && k == 1) return;
    const int at = first + place_in_arena(i, j, k);
    const NodeCounts n{Block::nearest(term.x * w), Block::nearest(term.y * w), Block::nearest(term.z * w),
                       Block::nearest(term.m * w)};
    Block::add(sums.x[at], n.x), Block::add(sums.y[at], n.y), Block::add(sums.z[at], n.z), Block::add(sums.m[at], n.m);
    left.x -= n.x, left.y -= n.y, left.z -= n.z, left.m -= n.m;
  });
  const int at = first + place_in_arena(1, 1, 1);
  Block::add(sums.x[at], left.x), Block::add(sums.y[at], left.y), Block::add(sums.z[at], left.z);
  Block::add(sums.m[at], left.m);
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
/// Thread `t`'s share of what goes to the arena of block `b` of the particles. Returns the largest
/// count of mass among it.
template <int threads>
DM_FN std::int32_t write(int t, int b, const ArenaSums& sums, const PassOutput::Arena& to) {
  std::int32_t most = 0;
  if (!to.counts) return most;
  for (int n = t; n < arena_nodes; n += threads) {
    const int at = ArenaNode(n).place();
    NodeCounts& node = to.counts[std::int64_t{b} * arena_nodes + n];
    NodeCounts count{sums.x[at], sums.y[at], sums.z[at], sums.m[at]};
    if (!to.first) count.x += node.x, count.y += node.y, count.z += node.z, count.m += node.m;
    node = count;
    if (count.m > most) most = count.m;
  }
  return most;
}

/// `relaxes`: whether this step relaxes the volume of liquids. `plain`: the set keeps no
/// velocities, and there is no mixture, no collider and no stage of viscosity. Whether somebody
/// looks at the motion does not decide: compilers of device code may round two kernels differently.
template <class M, bool relaxes, bool plain>
struct Pass {
  using Material = M;
  static constexpr int threads = 128;
  static constexpr int columns = state_columns<M>;
  static_assert(columns <= most_state_columns, "a material has more columns of state than ParticleColumns holds");

  struct RareSums {
    ArenaSums velocity_old, stress, mixture;
  };
  struct NoSums {};
  using OtherSums = std::conditional_t<plain, NoSums, RareSums>;
  union Shared {
    struct {
      NodeCopy nodes;
      ArenaSums field;
      OtherSums others;
    } arena;
    ParticleSums sums[threads];
  };

  typename M::template Law<float> law;
  SetStep<float> step;
  ScatterBounds bounds;
  PassInput in;
  PassOutput out;
  int field;       ///< that the set moves in
  bool by_volume;  ///< true if a density is measured by the mixture, and not by mass

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      copy_nodes<threads>(t, in.stencil_blocks + 8 * b, in.field, shared.arena.nodes);
      clear<threads>(t, shared.arena.field);
      if constexpr (!plain) {
        clear<threads>(t, shared.arena.others.velocity_old), clear<threads>(t, shared.arena.others.stress);
        clear<threads>(t, shared.arena.others.mixture);
      }
    });
    typename Block::template PerThread<ParticleSums> found;
    block.each_thread([&](int t) {
      found[t] = ParticleSums::none();
      const std::uint32_t end = in.block_start[b + 1];
      for (std::uint32_t p = in.block_start[b] + static_cast<std::uint32_t>(t); p < end; p += threads)
        advance<Block>(b, p, shared, found[t]);
    });
    block.each_thread([&](int t) {
      const auto most = static_cast<float>(write<threads>(t, b, shared.arena.field, out.field));
      found[t].scattered.mass = most / field_units(in.loads[b], field, bounds).mass;
      if constexpr (!plain) {
        write<threads>(t, b, shared.arena.others.velocity_old, out.velocity_old);
        write<threads>(t, b, shared.arena.others.stress, out.stress);
        write<threads>(t, b, shared.arena.others.mixture, out.mixture);
      }
    });
    block.each_thread([&](int t) { shared.sums[t] = found[t]; });
    for (int half = threads / 2; half > 0; half /= 2)
      block.each_thread([&](int t) {
        if (t < half) shared.sums[t].add(shared.sums[t + half]);
      });
    block.each_thread([&](int t) {
      if (t != 0) return;
      BlockSums sum = BlockSums::none();
      sum.add(shared.sums[0]);
      out.sums[b] = sum;
    });
  }

 private:
  template <class Block>
  DM_FN void advance(int b, std::uint32_t p, Shared& shared, ParticleSums& found) const {
    Vec3<float> u{in.particles.u[0][p], in.particles.u[1][p], in.particles.u[2][p]};
    const BlockWalls<float> walls = walls_of(b);
    G2PResult<float> g;
    gather_all(b, p, u, walls, shared.arena.nodes, g);
    typename M::template State<float> state;
    for (int k = 0; k < columns; ++k) state[k] = in.particles.state[k][p];
    StressResponse<float> response;
    bool pushed;
    SetStep<float> set = step;
    if constexpr (!relaxes) set.volume_relaxation = 0;
    if constexpr (plain) set.sub_cycled = false, set.transfer.blend = 0;
    const P2GTerms<float> s = particle_step<M, float>(law, set, walls, g, u, state, response, pushed);

    for (int a = 0; a < 3; ++a) out.particles.u[a][p] = u[a];
    for (int k = 0; k < columns; ++k) out.particles.state[k][p] = state[k];
    if constexpr (!plain)
      if (step.transfer.keeps_velocity())
        for (int a = 0; a < 3; ++a) out.particles.own_velocity[a][p] = s.own_velocity[a];
    const float j = volume_ratio(law, state);
    found.template add_particle<M>(set, walls, g, s, j, response, u, pushed);
    // A position that is not finite has no nodes to go to.
    if (!found.finite) return;
    scatter<Block>(b, u, g, s, j, response, set, shared, found);
    if (out.velocity) write_motion(p, g, s, j, response);
  }

  DM_FN BlockWalls<float> walls_of(int b) const {
    BlockWalls<float> walls = in.walls[b];
    if constexpr (plain) walls.colliders = false;
    return walls;
  }

  /// A node of the grid around a particle of block `b`.
  DM_FN std::int64_t node_of(int b, const Stencil<float>& s, int i, int j, int k) const {
    const int x = s.node(0) + i + 1, y = s.node(1) + j + 1, z = s.node(2) + k + 1;
    const int corner = (x / block_width * 2 + y / block_width) * 2 + z / block_width;
    return std::int64_t{in.stencil_blocks[8 * b + corner]} * block_nodes +
           node_index(x % block_width, y % block_width, z % block_width);
  }

  DM_FN void gather_all(int b, std::uint32_t p, const Vec3<float>& u, const BlockWalls<float>& walls,
                        const NodeCopy& nodes, G2PResult<float>& g) const {
    const Stencil<float> s = make_stencil(u);
    const auto found = gather<Vec3<float>, M::info.liquid ? all_bends : no_bends>(s, velocity_rows(s, nodes));
    g.v = found.value;
    for (int a = 0; a < 3; ++a) g.affine_moment[a] = found.first_moment[a];
    if constexpr (M::info.liquid) g.affine_excess = divergence_excess(found, s);
    if constexpr (measures<M>(relaxes ? 1.0f : 0.0f)) gather_density(b, s, nodes, g);
    if constexpr (!plain) gather_rare(b, p, s, walls, g);
  }

  /// `row(i, j, k)`: a number of a node.
  template <class Number>
  static DM_FN auto lines(const Number& number) {
    return [&number](int i, int j) { return line_spline<float>(number(i, j, 0), number(i, j, 1), number(i, j, 2)); };
  }

  DM_FN void gather_density(int b, const Stencil<float>& s, const NodeCopy& nodes, G2PResult<float>& g) const {
    const int first = place_in_arena(s.node(0) + 1, s.node(1) + 1, s.node(2) + 1);
    const auto mass = [&](int i, int j, int k) { return nodes.m[first + place_in_arena(i, j, k)]; };
    if constexpr (plain) {
      find_density(s, mass, NothingElse{}, g);
    } else {
      const auto held = [&](int i, int j, int k) {
        if (!by_volume) return mass(i, j, k);
        const Node<float> shares = in.mixture[node_of(b, s, i, j, k)];
        return mixture::filled(shares, static_cast<std::size_t>(field));
      };
      if (!(M::info.liquid && in.mixture)) return find_density(s, held, NothingElse{}, g);
      find_density(
          s, held,
          [&](int i, int j, int k) {
            const Node<float> shares = in.mixture[node_of(b, s, i, j, k)];
            return mixture::blocked(shares);
          },
          g);
    }
  }
  template <class Held, class Taken>
  DM_FN void find_density(const Stencil<float>& s, const Held& held, const Taken& taken, G2PResult<float>& g) const {
    constexpr bool shared = !std::is_same_v<Taken, NothingElse>;
    const Shared3 x(s.w[0], s.t[0]), y(s.w[1], s.t[1]);
    const LinePlace<float> z(s.t[2]);
    g.blocked = 0;
    if constexpr (shared) g.blocked = gather_value<float>(x, y, z, lines(taken));
    if constexpr (VolumeRelaxed<M>) {
      if constexpr (shared)
        g.density_state = density_state(x, y, z, s.t, step.full, lines(held), lines(taken));
      else
        g.density_state = density_state(x, y, z, s.t, step.full, lines(held));
      g.node_content = g.density_state.node_content;
    } else {
      g.node_content = gather_value<float>(x, y, z, lines(held));
    }
  }

  DM_FN void gather_rare(int b, std::uint32_t p, const Stencil<float>& s, const BlockWalls<float>& walls,
                         G2PResult<float>& g) const {
    const auto vectors = [&](const Node<float>* from) {
      return gather_value<Vec3<float>>(s, [&](int i, int j) {
        NodeRow<Vec3<float>> row;
        for (int k = 0; k < 3; ++k) {
          const Node<float> n = from[node_of(b, s, i, j, k)];
          row.n[k] = {n.x, n.y, n.z};
        }
        return row;
      });
    };
    if (walls.colliders) {
      const bool exact = in.distance[0] && in.distance[3][p] < no_distance;
      if (exact) {
        g.clearance_gradient = {in.distance[0][p], in.distance[1][p], in.distance[2][p]};
        g.clearance = in.distance[3][p];
      } else {
        g.clearance_gradient = vectors(in.clearance);
        const auto distance = [&](int i, int j, int k) { return in.clearance[node_of(b, s, i, j, k)].m; };
        g.clearance = gather_value<float>(Shared3(s.w[0], s.t[0]), Shared3(s.w[1], s.t[1]), LinePlace<float>(s.t[2]),
                                          lines(distance));
      }
    }
    if (step.transfer.keeps_velocity()) {
      g.own_velocity = {in.particles.own_velocity[0][p], in.particles.own_velocity[1][p],
                        in.particles.own_velocity[2][p]};
      g.velocity_old = vectors(in.velocity_old);
    }
  }

  template <class Block>
  DM_FN void scatter(int b, const Vec3<float>& u, const G2PResult<float>& g, const P2GTerms<float>& s, float j,
                     const StressResponse<float>& response, const SetStep<float>& set, Shared& shared,
                     ParticleSums& found) const {
    const Stencil<float> stencil = make_stencil(u);
    const ScatterUnits units = field_units(in.loads[b], field, bounds);
    found.scattered.speed = max(scattered_speed(s.q, s.slope, set.mass), found.scattered.speed);
    scatter_counts<Block>(stencil, s.q, s.slope, set.mass, units, shared.arena.field);
    if constexpr (!plain) {
      auto& others = shared.arena.others;
      if (out.velocity_old.counts && set.transfer.keeps_velocity()) {
        const OldVelocityTerm<float> old(s, g.affine_moment, set);
        // Without the stress, which may have taken from it.
        found.scattered.speed = max(scattered_speed(old.q, old.slope, set.mass), found.scattered.speed);
        scatter_counts<Block>(stencil, old.q, old.slope, old.mass, units, others.velocity_old);
      }
      if (out.stress.counts) {
        Vec3<float> slope[3];
        stress_slopes(set, response.tau, set.dt_next, slope);
        found.scattered.speed = max(scattered_speed({}, slope, set.mass), found.scattered.speed);
        scatter_counts<Block>(stencil, {}, slope, 0, units, others.stress);
      }
      if (out.mixture.counts) scatter_mixture<Block>(b, stencil, j, response, set, others.mixture, found);
    }
  }

  /// As MixtureShare: the volume that it fills and its viscosity if it is liquid, else the volume
  /// that it blocks.
  template <class Block>
  DM_FN void scatter_mixture(int b, const Stencil<float>& stencil, float j, const StressResponse<float>& response,
                             const SetStep<float>& set, ArenaSums& sums, ParticleSums& found) const {
    const float cells = set.volume / (set.dx * set.dx * set.dx);
    const float viscosity = M::info.liquid ? response.kinematic_viscosity + response.implicit_viscosity : 0.0f;
    const float blocked = M::info.liquid ? 0.0f : cells * j;
    found.scattered.viscosity = max(viscosity, found.scattered.viscosity);
    if (!M::info.liquid) found.scattered.volume_ratio = max(j, found.scattered.volume_ratio);
    const Vec3<float> none[3]{};
    scatter_counts<Block>(stencil, {blocked, field == 0 ? cells : 0.0f, field == 1 ? cells : 0.0f}, none,
                          viscosity * set.mass, mixture_units(in.loads[b], bounds), sums);
  }

  DM_FN void write_motion(std::uint32_t p, const G2PResult<float>& g, const P2GTerms<float>& s, float j,
                          const StressResponse<float>& response) const {
    const Mat3<float> gradient = affine_velocity(g.affine_moment, step.dx);
    for (int a = 0; a < 3; ++a) out.velocity[3 * std::size_t{p} + static_cast<std::size_t>(a)] = s.own_velocity[a];
    for (int k = 0; k < 9; ++k) out.gradient[9 * std::size_t{p} + static_cast<std::size_t>(k)] = gradient.m[k];
    out.energy[p] = response.energy;
    out.volume_ratio[p] = j;
  }

  using Shared3 = dreampm::Shared<float, 3>;
};

}  // namespace dreampm::gpu
