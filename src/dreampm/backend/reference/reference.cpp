#include "dreampm/backend/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dreampm/backend/common.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

template <class R>
class Reference final : public Backend<R> {
 public:
  std::string_view name() const override { return "reference"; }
  std::string_view isa() const override { return sizeof(R) == 4 ? "scalar" : "scalar-double"; }

  void attach(const World<R>& world) override {
    obstacles_ = {};
    refresh(world);
  }

  void sort(World<R>& world) override {
    regroup_(world, next_);
    refresh(world);
  }

  PassStats insert_particles(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    insert(world, set, seeds);
    refresh(world);
    return scatter_seeds(world, set, seeds, obstacles_);
  }

  PassStats state_bounds(const World<R>& world) override { return dreampm::state_bounds(world); }

  void scatter_particles(World<R>& world, const Motion<R>& motion) override {
    dreampm::scatter_particles(world, motion, obstacles_);
  }

  GridStats grid_update(World<R>& world, double dt) override { return update_(world, obstacles_, dt); }

  double sub_cycle(World<R>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    return update_.sub_cycle(
        world, obstacles_, dt, found, next_,
        [&] {
          std::fill(next_.nodes.begin(), next_.nodes.end(), Node<R>{});
          std::fill(next_.solids.begin(), next_.solids.end(), Node<R>{});
          for (const ParticleSet<R>& set : world.sets)
            Materials::with(set.material, [&]<class M>() {
              if constexpr (Viscous<M>) add_viscous_forces<M>(world, set, dt);
            });
        },
        [&] {
          R fastest2(0);
          for (const ParticleSet<R>& set : world.sets) {
            const Nodes<R>& field = world.grid.field(world.field_of(set));
            for_each(world, set, [&](std::size_t b, std::size_t, const Vec3<R>& u) {
              Vec3<R> v{};
              for_stencil(b, make_stencil(u),
                          [&](R w, std::size_t n) { v += Vec3<R>{field[n].x, field[n].y, field[n].z} * w; });
              fastest2 = std::max(fastest2, dot(v, v));
            });
          }
          return std::sqrt(static_cast<double>(fastest2));
        });
  }

  PassStats g2p2g(World<R>& world, double dt, double dt_next, Motion<R>* motion) override {
    fit_grid(world, next_);
    parallel_region([&](ThreadTeam& team) {
      team.loop(world.grid.blocks.size(), 32, [&](std::size_t b) { clear_block(world, obstacles_, next_, b); });
      update_.images().add_image_mass(team, world, dt);
    });
    if (motion) motion->sets.assign(world.sets.size(), {});
    PassStats stats;
    for (std::size_t s = 0; s < world.sets.size(); ++s)
      Materials::with(world.sets[s].material, [&]<class M>() {
        stats.add(pass<M>(world, world.sets[s], dt, dt_next, motion ? &motion->sets[s] : nullptr));
      });
    swap_fields(world.grid, next_);
    return stats;
  }

 private:
  // After every change of the block lists.
  void refresh(const World<R>& world) {
    obstacles_.prepare(world);
    find_stencil_blocks(world, stencil_blocks_);
    thin_.clear();
    for (const StencilBlocks& stencil_blocks : stencil_blocks_) thin_.emplace_back(obstacles_, stencil_blocks);
    update_.prepare(world, obstacles_);
  }

  // Node (i, j, k) relative to first_stencil() of particle block b.
  std::size_t node_at(std::size_t b, int i, int j, int k) const {
    ++i, ++j, ++k;
    const int n = (i >> 2) * 4 + (j >> 2) * 2 + (k >> 2);
    return static_cast<std::size_t>(stencil_blocks_[b][static_cast<std::size_t>(n)]) * block_nodes +
           node_index(i & 3, j & 3, k & 3);
  }

  template <class M>
  void add_viscous_forces(const World<R>& world, const ParticleSet<R>& set, double dt) {
    const auto law = M::template Law<R>::from(set.values);
    const SetStep<R> step = set_step(world, set, dt, dt);
    const std::size_t number = world.field_of(set);
    const Nodes<R>& field = world.grid.field(number);
    Nodes<R>& to = next_.field(number);
    for_each(world, set, [&](std::size_t b, std::size_t p, const Vec3<R>& u) {
      const Stencil<R> st = make_stencil(u);
      const auto at = [&](int i, int j, int k) { return node_at(b, st.node(0) + i, st.node(1) + j, st.node(2) + k); };
      const Moments<Node<R>> m = gather<Node<R>, no_bends>(st, [&](int i, int j) {
        return NodeRow<Node<R>>{{field[at(i, j, 0)], field[at(i, j, 1)], field[at(i, j, 2)]}};
      });
      Vec3<R> affine_moment[3], slopes[3];
      for (int a = 0; a < 3; ++a) affine_moment[a] = {m.first_moment[a].x, m.first_moment[a].y, m.first_moment[a].z};
      typename M::template State<R> state;
      for (int c = 0; c < state_columns<M>; ++c) state[c] = set.state[static_cast<std::size_t>(c)][p];
      viscous_slopes<M, R>(law, step, state, affine_moment, slopes);
      Node<R> slope[3];
      for (int a = 0; a < 3; ++a) slope[a] = {slopes[a].x, slopes[a].y, slopes[a].z, R(0)};
      scatter(st, Node<R>{}, slope, [&](int i, int j, int k) -> Node<R>& { return to[at(i, j, k)]; });
    });
  }

  template <class M>
  PassStats pass(World<R>& world, ParticleSet<R>& set, double dt, double dt_next, typename Motion<R>::Set* motion) {
    const auto law = M::template Law<R>::from(set.values);
    const SetStep<R> step = set_step(world, set, dt, dt_next);
    const bool mixed = !world.grid.mixture.empty();
    const std::size_t number = world.field_of(set);
    const bool by_volume = world.measures_by_volume(number);
    const Nodes<R>& field = world.grid.field(number);
    Nodes<R>& next = next_.field(number);
    const Nodes<R>& before = world.grid.velocity_old[number];
    Nodes<R>& next_before = next_.velocity_old[number];
    const bool keeps = set.transfer.keeps_velocity();
    const std::size_t n = set.size();
    std::vector<G2PResult<R>> gathered(n);
    std::vector<P2GTerms<R>> scattered(n);
    std::vector<R> ratio(n), viscosity(n);
    std::vector<Sym3<R>> stress(n);
    PassStats stats;

    // G2P: velocity and its first moments at the old position.
    for_each(world, set, [&](std::size_t b, std::size_t p, const Vec3<R>& u) {
      const Stencil<R> st = make_stencil(u);
      const auto row = [&](int i, int j) {
        const auto at = [&](int k) { return field[node_at(b, st.node(0) + i, st.node(1) + j, st.node(2) + k)]; };
        return NodeRow<Node<R>>{{at(0), at(1), at(2)}};
      };
      const Moments<Node<R>> m = gather<Node<R>, M::info.liquid ? all_bends : no_bends>(st, row);
      G2PResult<R>& g = gathered[p];
      g.v = {m.value.x, m.value.y, m.value.z};
      for (int a = 0; a < 3; ++a) g.affine_moment[a] = {m.first_moment[a].x, m.first_moment[a].y, m.first_moment[a].z};
      if constexpr (M::info.liquid)
        g.excess = m.bend[0].x * affine_excess(st.t[0]) + m.bend[1].y * affine_excess(st.t[1]) +
                   m.bend[2].z * affine_excess(st.t[2]);
      if (measures<M>(step.volume_relaxation)) {
        const auto held = [&](std::size_t node) {
          return by_volume ? mixture::filled(world.grid.mixture[node], number) : field[node].m;
        };
        const auto taken = [&](std::size_t node) {
          return mixed && M::info.liquid ? mixture::blocked(world.grid.mixture[node]) : R(0);
        };
        g.content = g.blocked = R(0);
        for_stencil(b, st, [&](R w, std::size_t node) { g.content += w * held(node), g.blocked += w * taken(node); });
        if constexpr (VolumeRelaxed<M>) {
          const auto rows_of = [&](const auto& value) {
            return [&](int i, int j) {
              const auto at = [&](int k) { return value(node_at(b, st.node(0) + i, st.node(1) + j, st.node(2) + k)); };
              return line_spline<R>(at(0), at(1), at(2));
            };
          };
          g.density_state = density_state(Shared<R, 3>(st.w[0], st.t[0]), Shared<R, 3>(st.w[1], st.t[1]),
                                          LinePlace<R>(st.t[2]), st.t, step.full, rows_of(held), rows_of(taken));
        }
      }
      if (const std::optional<Node<R>> d = thin_[b].any() ? thin_[b].at(u) : std::nullopt) {
        g.away = {d->x, d->y, d->z}, g.clearance = d->m;
      } else if (colliders_near(obstacles_, stencil_blocks_[b])) {
        g.away = {}, g.clearance = R(0);
        for_stencil(b, st, [&](R w, std::size_t node) {
          const Node<float>& c = obstacles_.clearance()[node];
          g.away += Vec3<R>{static_cast<R>(c.x), static_cast<R>(c.y), static_cast<R>(c.z)} * w;
          g.clearance += w * static_cast<R>(c.m);
        });
      }
      if (keeps) {
        g.own = {set.own[0][p], set.own[1][p], set.own[2][p]};
        g.velocity_old = {};
        for_stencil(b, st, [&](R w, std::size_t node) {
          g.velocity_old += Vec3<R>{before[node].x, before[node].y, before[node].z} * w;
        });
      }
    });

    // The law, and the move.
    for_each(world, set, [&](std::size_t b, std::size_t p, Vec3<R> u) {
      const BlockWalls<R> walls =
          block_walls(world, world.particle_blocks[b], colliders_near(obstacles_, stencil_blocks_[b]));
      typename M::template State<R> state;
      for (int c = 0; c < state_columns<M>; ++c) state[c] = set.state[static_cast<std::size_t>(c)][p];
      StressResponse<R> response;
      bool pushed;
      scattered[p] = particle_step<M, R>(law, step, walls, gathered[p], u, state, response, pushed);
      for (int c = 0; c < state_columns<M>; ++c) set.state[static_cast<std::size_t>(c)][p] = state[c];
      for (int a = 0; a < 3; ++a) set.u[static_cast<std::size_t>(a)][p] = u[a];
      if (keeps)
        for (int a = 0; a < 3; ++a) set.own[static_cast<std::size_t>(a)][p] = scattered[p].own[a];
      ratio[p] = volume_ratio(law, state);
      stress[p] = response.tau;
      viscosity[p] = response.kinematic_viscosity + response.implicit_viscosity;
      stats.wave_speed = std::max(stats.wave_speed, static_cast<double>(response.sound_speed));
      stats.viscosity = std::max(stats.viscosity, static_cast<double>(response.kinematic_viscosity));
      stats.j_min = std::min(stats.j_min, static_cast<double>(ratio[p]));
      stats.j_max = std::max(stats.j_max, static_cast<double>(ratio[p]));
      stats.pushed += pushed;
      bool shifts = walls.colliders;
      if constexpr (VolumeRelaxed<M>)
        if (measures<M>(step.volume_relaxation)) {
          shifts = true;
          stats.swollen += static_cast<double>(scattered[p].swollen) * static_cast<double>(step.volume);
        }
      if (shifts) {
        const Vec3d shifted = static_cast<Vec3d>(scattered[p].shifted) * (set.mass * world.dx);
        stats.shifted += shifted, stats.turned += cross(shifted, static_cast<Vec3d>(scattered[p].own));
      }
      const double mass = static_cast<double>(step.mass), volume = static_cast<double>(step.volume);
      const double kinetic = static_cast<double>(kinetic_energy(gathered[p], scattered[p], step)) * mass;
      stats.energy += {kinetic, keeps ? kinetic : 0, static_cast<double>(response.dissipation.viscous) * volume,
                       static_cast<double>(response.dissipation.plastic) * volume,
                       static_cast<double>(response.dissipation.relaxed) * volume};
      const R sum = u.x + u.y + u.z + ratio[p] + response.sound_speed;
      stats.finite = stats.finite && std::isfinite(sum);
      if (motion) {
        motion->velocity.push_back(scattered[p].own);
        motion->gradient.push_back(affine_velocity(gathered[p].affine_moment, step.dx));
        motion->energy.push_back(response.energy);
        motion->volume_ratio.push_back(ratio[p]);
      }
    });
    if (!stats.finite) return stats;

    // P2G at the new position.
    const R cells = static_cast<R>(set.rest_volume / (world.dx * world.dx * world.dx));
    for_each(world, set, [&](std::size_t b, std::size_t p, const Vec3<R>& u) {
      const Stencil<R> st = make_stencil(u);
      const P2GTerms<R>& o = scattered[p];
      const auto scatter_to = [&](Nodes<R>& nodes, const Vec3<R>& q, const Vec3<R>(&slopes)[3], R mass) {
        Node<R> slope[3];
        for (int a = 0; a < 3; ++a) slope[a] = {slopes[a].x, slopes[a].y, slopes[a].z, R(0)};
        scatter(st, Node<R>{q.x, q.y, q.z, mass}, slope, [&](int i, int j, int k) -> Node<R>& {
          return nodes[node_at(b, st.node(0) + i, st.node(1) + j, st.node(2) + k)];
        });
      };
      scatter_to(next, o.q, o.slope, step.mass);
      if (step.sub_cycled) {
        Vec3<R> slopes[3];
        stress_slopes(step, stress[p], step.dt_next, slopes);
        scatter_to(next_.stress[number], {}, slopes, R(0));
      }
      if (keeps) {
        const OldVelocityTerm<R> own(o, gathered[p].affine_moment, step);
        scatter_to(next_before, own.q, own.slope, own.mass);
      }
      if (mixed)
        for_stencil(b, st, [&](R w, std::size_t node) {
          Node<R>& m = next_.mixture[node];
          mixture::filled(m, number) += w * cells;
          if (set.liquid)
            mixture::viscosity(m) += w * step.mass * viscosity[p];
          else
            mixture::blocked(m) += w * cells * ratio[p];
        });
    });
    return stats;
  }

  template <class Body>
  void for_each(const World<R>& world, const ParticleSet<R>& set, const Body& body) const {
    for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p)
        body(b, p, Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]});
  }
  template <class Body>
  void for_stencil(std::size_t b, const Stencil<R>& st, const Body& body) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          body(st.weight(i, j, k), node_at(b, st.node(0) + i, st.node(1) + j, st.node(2) + k));
  }

  Obstacles obstacles_;
  Regroup<R> regroup_;
  GridUpdate<R> update_;
  std::vector<StencilBlocks> stencil_blocks_;  // by block of particles, as the next
  std::vector<ThinWalls> thin_;
  GridFields<R> next_;  // its block list stays empty
};

}  // namespace

template <class R>
std::unique_ptr<Backend<R>> make_reference_backend() {
  return std::make_unique<Reference<R>>();
}
template std::unique_ptr<Backend<float>> make_reference_backend();
template std::unique_ptr<Backend<double>> make_reference_backend();

}  // namespace dreampm
