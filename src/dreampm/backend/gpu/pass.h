// One pass over the particles of a set on a device: gather, law, move, scatter. A block of threads
// takes a block of particles; physics/particle.h says what happens to one.
#pragma once
#include "dreampm/backend/gpu/add_up.h"
#include "dreampm/backend/gpu/arena_memory.h"
#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/block_particles.h"
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
  const std::uint32_t* some;  ///< the blocks of particles that the pass visits; null: all
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
  ArenaOutput field, velocity_old, stress, mixture;
  BlockSums* sums;  ///< by block of particles
  // Columns for output, as in Motion, or null.
  float *velocity, *gradient, *energy, *volume_ratio;
};

/// `relaxes`: whether this step relaxes the volume of liquids. `plain`: the set keeps no
/// velocities and gives nothing to a mixture, there is no stage of viscosity, and no collider is
/// near the blocks that it visits. Whether somebody looks at the motion does not decide: compilers
/// of device code may round two kernels differently.
template <class M, bool relaxes, bool plain>
struct Pass {
  using Material = M;
  static constexpr int threads = 128;
  static constexpr int columns = state_columns<M>;
  /// Four blocks to a multiprocessor are 128 registers a thread: few enough to hide waiting, and no
  /// plain kernel spills, but for those that relax a law with a tensor of state.
  static constexpr int resident = !plain ? 1 : relaxes && columns > 4 ? 3 : 4;
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
    const int b = in.some ? static_cast<int>(in.some[block.index()]) : block.index();
    if (in.block_start[b] == in.block_start[b + 1]) return nothing_there(block, b);
    block.each_thread([&](int t) {
      copy_nodes<threads>(t, in.stencil_blocks + 8 * b, in.field, shared.arena.nodes);
      clear<threads>(t, shared.arena.field);
      if constexpr (!plain) {
        auto& others = shared.arena.others;
        if (out.velocity_old.counts) clear<threads>(t, others.velocity_old);
        if (out.stress.counts) clear<threads>(t, others.stress);
        if (out.mixture.counts) clear<threads>(t, others.mixture);
      }
    });
    typename Block::template PerThread<ParticleSums> found;
    block.each_thread([&](int t) {
      found[t] = ParticleSums::none();
      each_particle_apart<threads>(in.block_start, static_cast<std::uint32_t>(b), t,
                                   [&](std::uint32_t p) { advance<Block>(b, p, shared, found[t]); });
    });
    block.each_thread([&](int t) {
      const Written written = write<threads>(t, b, shared.arena.field, out.field);
      found[t].scattered.mass = static_cast<float>(written.most) / field_units(in.loads[b], field, bounds).mass;
      found[t].counts -= written.counts;
      if constexpr (!plain) {
        write<threads>(t, b, shared.arena.others.velocity_old, out.velocity_old);
        write<threads>(t, b, shared.arena.others.stress, out.stress);
        write<threads>(t, b, shared.arena.others.mixture, out.mixture);
      }
    });
    block.each_thread([&](int t) { shared.sums[t] = found[t]; });
    add_up_threads<threads>(block, shared.sums);
    block.each_thread([&](int t) {
      if (t != 0) return;
      BlockSums sum = BlockSums::none();
      sum.add(shared.sums[0]);
      // Where a node had more than was assumed, its count may have begun anew.
      if (sum.counts != 0) sum.scattered.mass = in.loads[b].mass[field];
      out.sums[b] = sum;
    });
  }

 private:
  /// A block without particles of this set.
  template <class Block>
  DM_FN void nothing_there(Block& block, int b) const {
    block.each_thread([&](int t) {
      write_zeros<threads>(t, b, out.field);
      if constexpr (!plain) {
        write_zeros<threads>(t, b, out.velocity_old), write_zeros<threads>(t, b, out.stress);
        write_zeros<threads>(t, b, out.mixture);
      }
      if (t == 0) out.sums[b] = BlockSums::none();
    });
  }

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
    return node_in_reach(in.stencil_blocks + 8 * b, s, i, j, k);
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
    found.counts += Block::nearest(set.mass * units.mass);
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
        scatter_counts<Block, vector_part>(stencil, {}, slope, 0, units, others.stress);
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
    const Vec3<float> shares{blocked, field == 0 ? cells : 0.0f, field == 1 ? cells : 0.0f}, none[3]{};
    const auto give = [&]<unsigned parts>() {
      scatter_counts<Block, parts>(stencil, shares, none, viscosity * set.mass, mixture_units(in.loads[b], bounds),
                                   sums);
    };
    constexpr unsigned own = M::info.liquid ? mass_part : x_part;
    field == 0 ? give.template operator()<own | y_part>() : give.template operator()<own | z_part>();
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
