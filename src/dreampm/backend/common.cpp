#include "dreampm/backend/common.h"

#include <algorithm>
#include <cmath>

#include "dreampm/backend/scatter_particles.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/thread_team.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/volume_relaxation.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

constexpr double far_away = 1e6;  // cells: a wall that is not there

template <class R>
StressResponse<R> response_at_rest(const ParticleSet<R>& set) {
  StressResponse<R> response;
  Materials::with(set.material, [&]<class M>() {
    const auto law = M::template Law<R>::from(set.values);
    typename M::template State<R> rest;
    for (int c = 0; c < state_columns<M>; ++c) rest[c] = static_cast<R>(M::template State<R>::rest[c]);
    response = law.respond(rest);
  });
  return response;
}

}  // namespace

void PassStats::add(const PassStats& b) {
  // All members, so that a new one does not compile before it is added here.
  const auto& [b_wave_speed, b_viscosity, b_j_min, b_j_max, b_pushed, b_finite, b_energy, b_shifted, b_turned,
               b_swollen] = b;
  wave_speed = std::max(wave_speed, b_wave_speed);
  viscosity = std::max(viscosity, b_viscosity);
  j_min = std::min(j_min, b_j_min);
  j_max = std::max(j_max, b_j_max);
  pushed += b_pushed;
  finite = finite && b_finite;
  energy += b_energy;
  shifted += b_shifted;
  turned += b_turned;
  swollen += b_swollen;
}

template <class R>
void find_stencil_blocks(const World<R>& world, std::vector<StencilBlocks>& all) {
  resize_for_overwrite(all, world.particle_blocks.size());
  parallel_for(all.size(), 64,
               [&](std::size_t b) { all[b] = stencil_blocks_in(world.grid.blocks, world, world.particle_blocks[b]); });
}

template <class R>
BlockWalls<R> block_walls(const World<R>& world, const Vec3i& block, bool colliders) {
  constexpr double reach = 2.5, first = -0.5, last = block_width + 1.5;  // where the block's particles may be
  BlockWalls<R> w{};
  w.colliders = colliders;
  const Vec3i from = first_stencil(block);
  for (int a = 0; a < 3; ++a) {
    const bool low = world.walls[2 * a].type != WallType::open, high = world.walls[2 * a + 1].type != WallType::open;
    w.low[a] = low ? static_cast<R>(world.low[a] - from[a]) : R(-far_away);
    w.high[a] = high ? static_cast<R>(world.high[a] - from[a]) : R(far_away);
    w.truncates_kernel[a] = (low && !has_image_mass(world, 2 * a)) || (high && !has_image_mass(world, 2 * a + 1));
    w.near = w.near || w.low[a] > R(first - reach) || w.high[a] < R(last + reach);
  }
  return w;
}

template <class R>
SetStep<R> set_step(const World<R>& world, const ParticleSet<R>& set, double dt, double dt_next) {
  const double cell = world.dx * world.dx * world.dx;
  TransferRule<double> transfer = set.transfer;
  transfer.blend = set.transfer.kept(world.kept_for);
  return {static_cast<R>(dt),
          static_cast<R>(dt_next),
          static_cast<R>(world.dx),
          static_cast<R>(set.mass),
          static_cast<R>(set.rest_volume),
          static_cast<R>(world.measures_by_volume(world.field_of(set)) ? 1 : set.mass / set.rest_volume * cell),
          world.settings.keep_inside,
          static_cast<R>(set.liquid ? ColliderContact::inside_margin
                                    : std::max(ColliderContact::inside_margin,
                                               ColliderContact::solid_margin * set.spacing() / world.dx)),
          static_cast<TransferRule<R>>(transfer),
          static_cast<R>(set.transfer.kept(dt_next)),
          static_cast<R>(volume_relaxation_time(world, dt) / (VolumeCorrection::relaxation_cells * world.dx)),
          world.viscous_stages > 0,
          static_cast<R>(world.node_speed / std::sqrt(3.0))};
}

template <class R>
void add_colliders(const World<R>& world, const Obstacles& obstacles, std::size_t block, Node<R>* nodes) {
  const Vec3i first = world.grid.blocks[block] * block_width;
  for (const ObstacleNode& o : obstacles.at(block))
    mixture::blocked(nodes[o.node]) += without_images(world, first + node_offset(o.node), static_cast<R>(o.taken));
}

template <class R>
void fit_grid(const World<R>& world, GridFields<R>& next) {
  const std::size_t nodes = world.grid.nodes.size();
  visit_nodes(next, world.grid, [&]<class F>(const F& field, auto& to, const auto& now) {
    // Arrays that a sort does not carry over get the size that the coming step needs.
    to.resize(F::use.carried ? now.size() : field.needed(world) ? nodes : 0);
  });
}

template <class R>
void clear_block(const World<R>& world, const Obstacles& obstacles, GridFields<R>& next, std::size_t block) {
  visit_nodes(next, [&](const auto&, auto& nodes) {
    if (!nodes.empty()) std::fill_n(nodes.data() + block * block_nodes, block_nodes, Node<R>{});
  });
  if (!next.mixture.empty()) add_colliders(world, obstacles, block, next.mixture.data() + block * block_nodes);
}

template <class R>
void begin_pass(World<R>& world, const Obstacles& obstacles, const MirrorWalls<R>& images, GridFields<R>& next,
                double dt) {
  fit_grid(world, next);
  parallel_region([&](ThreadTeam& team) {
    team.loop(world.grid.blocks.size(), 32, [&](std::size_t b) { clear_block(world, obstacles, next, b); });
    images.add_image_mass(team, world, dt);
  });
}

template <class R>
void swap_fields(GridFields<R>& a, GridFields<R>& b) {
  visit_nodes(a, b, [](const auto&, auto& its, auto& other) { its.swap(other); });
}

template <class R>
PassStats scatter_seeds(World<R>& world, std::size_t index, std::span<const ParticleSeed> seeds,
                        const Obstacles& obstacles) {
  // The colliders' share of the mixture, where the grid is new.
  if (!world.grid.mixture.empty())
    for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) {
      Node<R>* const m = world.grid.mixture.data() + b * block_nodes;
      const bool fresh = std::all_of(m, m + block_nodes,
                                     [](const Node<R>& n) { return n.x == 0 && n.y == 0 && n.z == 0 && n.m == 0; });
      if (fresh) add_colliders(world, obstacles, b, m);
    }
  return add_seeds(world, index, seeds);
}

template <class R>
PassStats add_seeds(World<R>& world, std::size_t index, std::span<const ParticleSeed> seeds) {
  ParticleSet<R>& set = world.sets.at(index);
  const SetStep<R> step = set_step(world, set, 0, world.kept_for);
  PassStats stats;
  const StressResponse<R> rest = response_at_rest<R>(set);
  stats.wave_speed = static_cast<double>(rest.sound_speed);
  stats.viscosity = static_cast<double>(rest.kinematic_viscosity);
  stats.j_min = stats.j_max = 1;
  const NodesToAddTo<R> to = nodes_to_add_to(world, set);
  for (const ParticleSeed& n : seeds) {
    const auto home = world.locate(n.position);
    const Vec3i first = first_stencil(home.block);
    const Stencil<R> stencil = make_stencil(home.at);
    const auto index_of = [&](int i, int j, int k) {
      const Vec3i at = first + Vec3i{stencil.node(0) + i, stencil.node(1) + j, stencil.node(2) + k};
      return static_cast<std::size_t>(world.grid.blocks.find(world.wrapped(block_of(at)))) * block_nodes +
             node_index(at.x & 3, at.y & 3, at.z & 3);
    };
    ParticleTerms<R> terms;
    terms.momentum = static_cast<Vec3<R>>(n.velocity) * step.mass;
    for (int a = 0; a < 3; ++a)
      terms.affine[a] = static_cast<Vec3<R>>(n.gradient.column(a) * world.dx) * step.mass * step.transfer.affine;
    terms.viscosity = rest.kinematic_viscosity;
    add_particle(world, set, step, stencil, terms, to, index_of);
  }
  return stats;
}

#define DM_INSTANTIATE(R)                                                                                    \
  template void find_stencil_blocks(const World<R>&, std::vector<StencilBlocks>&);                           \
  template BlockWalls<R> block_walls(const World<R>&, const Vec3i&, bool);                                   \
  template SetStep<R> set_step(const World<R>&, const ParticleSet<R>&, double, double);                      \
  template void fit_grid(const World<R>&, GridFields<R>&);                                                   \
  template void add_colliders(const World<R>&, const Obstacles&, std::size_t, Node<R>*);                     \
  template void clear_block(const World<R>&, const Obstacles&, GridFields<R>&, std::size_t);                 \
  template void begin_pass(World<R>&, const Obstacles&, const MirrorWalls<R>&, GridFields<R>&, double);      \
  template void swap_fields(GridFields<R>&, GridFields<R>&);                                                 \
  template PassStats scatter_seeds(World<R>&, std::size_t, std::span<const ParticleSeed>, const Obstacles&); \
  template PassStats add_seeds(World<R>&, std::size_t, std::span<const ParticleSeed>);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
