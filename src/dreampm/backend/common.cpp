#include "dreampm/backend/common.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {
namespace {

constexpr double far_away = 1e6;  // cells: a wall that is not there

template <class R>
BoxWalls<R> box_walls(const World<R>& world) {
  BoxWalls<R> w;
  for (int a = 0; a < 3; ++a) w.low[a] = world.low[a], w.high[a] = world.high[a];
  for (int s = 0; s < 6; ++s) w.type[s] = world.walls[s].type, w.friction[s] = static_cast<R>(world.walls[s].friction);
  return w;
}

/// What the nodes of one block found.
struct NodeSums {
  double max_speed = 0, mass = 0;
  Vec3d moment{};
  Push damping, fields;
  std::vector<Push> pushes;  ///< the six walls, then the colliders; empty where there are none
  bool finite = true;
};

}  // namespace

void PassStats::add(const PassStats& b) {
  wave_speed = std::max(wave_speed, b.wave_speed);
  viscosity = std::max(viscosity, b.viscosity);
  j_min = std::min(j_min, b.j_min);
  j_max = std::max(j_max, b.j_max);
  pushed += b.pushed;
  finite = finite && b.finite;
}

void Push::add(const Vec3d& at, double mass, const Vec3d& before, const Vec3d& after) {
  const Vec3d received = (after - before) * mass;
  impulse += received;
  angular += cross(at, received);
  work += 0.5 * dot(received, before + after);
}

Push& Push::operator+=(const Push& b) {
  impulse += b.impulse;
  angular += b.angular;
  work += b.work;
  return *this;
}

Push GridStats::contact() const {
  Push all;
  for (const Push& p : walls) all += p;
  for (const Push& p : colliders) all += p;
  return all;
}

template <class R>
std::vector<Neighbours> neighbours_of(const World<R>& world) {
  std::vector<Neighbours> all(world.particle_blocks.size());
  parallel_for(all.size(), 64, [&](std::size_t b) {
    for (int n = 0; n < 27; ++n)
      all[b][n] =
          world.grid.blocks.find(world.wrapped(world.particle_blocks[b] + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}));
  });
  return all;
}

template <class R>
GridStats update_grid(World<R>& world, const Obstacles& obstacles, double dt) {
  const BoxWalls<R> walls = box_walls(world);
  const Vec3<R> kick = static_cast<Vec3<R>>(world.gravity_over(dt) * dt);
  const R keep = static_cast<R>(std::exp(-world.settings.damping * dt));
  const FieldSteps<R> fields(world, dt);
  const bool damped = keep != R(1);
  const std::size_t blocks = world.grid.blocks.size();
  std::vector<NodeSums> partial(blocks);
  parallel_for(blocks, 32, [&](std::size_t b) {
    NodeSums& stats = partial[b];
    const Vec3i first = world.grid.blocks[b] * block_width;
    Node<R>* nodes = world.grid.nodes.data() + b * block_nodes;
    const auto& near = obstacles.at(b);
    bool touches = !near.empty();
    for (int a = 0; a < 3; ++a) touches = touches || first[a] <= walls.low[a] || first[a] + block_width > walls.high[a];
    if (touches) stats.pushes.resize(6 + world.colliders.size());
    const Vec3d corner = world.origin + static_cast<Vec3d>(first - world.low) * world.dx;
    const auto place = [&](int n) {
      return corner +
             Vec3d{static_cast<double>(n / 16), static_cast<double>(n / 4 % 4), static_cast<double>(n % 4)} * world.dx;
    };
    R fastest2(0);
    for (int n = 0; n < block_nodes; ++n) {
      Node<R>& node = nodes[n];
      if (!(node.m > R(1e-36))) {
        // NaN mass must not hide as an empty node.
        if (!(node.m >= R(0))) stats.finite = false;
        node = {};
        continue;
      }
      Vec3<R> v = Vec3<R>{node.x, node.y, node.z} * (R(1) / node.m);
      const double m = static_cast<double>(node.m);
      stats.mass += m;
      stats.moment += place(n) * m;
      const auto push = [&](Push& from, const Vec3<R>& before, const Vec3<R>& after) {
        if (!(before == after)) from.add(place(n), m, static_cast<Vec3d>(before), static_cast<Vec3d>(after));
      };
      if (damped) push(stats.damping, v, v * keep);
      v = v * keep + kick;
      if (fields.any()) {
        const Vec3<R> before = v;
        v = fields.apply(v, world.node_position(first + node_offset(n)));
        push(stats.fields, before, v);
      }
      if (touches) {
        const int at[3] = {first.x + n / 16, first.y + n / 4 % 4, first.z + n % 4};
        for (const ObstacleNode& o : near)
          if (o.node == n && o.inside) {
            const Vec3<R> before = v;
            v = contact(v, static_cast<Vec3<R>>(o.normal), world.colliders[o.collider].type,
                        static_cast<R>(world.colliders[o.collider].friction));
            push(stats.pushes[6 + o.collider], before, v);
          }
        v = box_contact(v, at, walls, [&](int side, const Vec3<R>& before, const Vec3<R>& after) {
          push(stats.pushes[static_cast<std::size_t>(side)], before, after);
        });
      }
      node.x = v.x, node.y = v.y, node.z = v.z;
      fastest2 = max(dot(v, v), fastest2);
      if (!(dot(v, v) < R(1e30))) stats.finite = false;
    }
    stats.max_speed = std::sqrt(static_cast<double>(fastest2));
  });
  GridStats total;
  total.colliders.resize(world.colliders.size());
  for (const NodeSums& s : partial) {
    total.max_speed = std::max(total.max_speed, s.max_speed);
    total.mass += s.mass;
    total.moment += s.moment;
    total.damping += s.damping;
    total.fields += s.fields;
    total.finite = total.finite && s.finite;
    for (std::size_t i = 0; i < s.pushes.size(); ++i) (i < 6 ? total.walls[i] : total.colliders[i - 6]) += s.pushes[i];
  }
  return total;
}

template <class R>
BlockWalls<R> block_walls(const World<R>& world, const Vec3i& block) {
  BlockWalls<R> w;
  for (int a = 0; a < 3; ++a) {
    const bool low = world.walls[2 * a].type != WallType::open, high = world.walls[2 * a + 1].type != WallType::open;
    w.low[a] = low ? static_cast<R>(world.low[a] - block[a] * block_width) : R(-far_away);
    w.high[a] = high ? static_cast<R>(world.high[a] - block[a] * block_width) : R(far_away);
  }
  return w;
}

template <class R>
SetStep<R> set_step(const World<R>& world, const ParticleSet<R>& set, double dt, double dt_next) {
  const double cell = world.dx * world.dx * world.dx;
  return {static_cast<R>(dt),        static_cast<R>(dt_next),         static_cast<R>(world.dx),
          static_cast<R>(set.mass),  static_cast<R>(set.rest_volume), static_cast<R>(set.mass / set.rest_volume * cell),
          world.settings.keep_inside};
}

template <class R>
void clear_grid(const World<R>& world, const Obstacles& obstacles, std::vector<Node<R>>& nodes,
                std::vector<LiquidNode<R>>& liquid) {
  const std::size_t blocks = world.grid.blocks.size();
  nodes.resize(blocks * block_nodes);
  liquid.resize(world.grid.liquid.size());
  parallel_for(blocks, 128, [&](std::size_t b) {
    std::fill_n(nodes.begin() + static_cast<std::ptrdiff_t>(b * block_nodes), block_nodes, Node<R>{});
    if (liquid.empty()) return;
    LiquidNode<R>* l = liquid.data() + b * block_nodes;
    std::fill_n(l, block_nodes, LiquidNode<R>{});
    for (const ObstacleNode& o : obstacles.at(b)) l[o.node].blocked += static_cast<R>(o.blocked);
  });
}

template <class R>
PassStats scatter_newborns(World<R>& world, std::size_t index, std::span<const Newborn> newborns,
                           const Obstacles& obstacles) {
  ParticleSet<R>& set = world.sets.at(index);
  const SetStep<R> step = set_step(world, set, 0, 0);
  const R per_cell = static_cast<R>(set.rest_volume / (world.dx * world.dx * world.dx));
  PassStats stats;
  // The colliders' share of the liquid channel, where the grid is new.
  if (!world.grid.liquid.empty())
    for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) {
      LiquidNode<R>* l = world.grid.liquid.data() + b * block_nodes;
      const bool fresh =
          std::all_of(l, l + block_nodes, [](const LiquidNode<R>& n) { return n.mass == 0 && n.blocked == 0; });
      if (fresh)
        for (const ObstacleNode& o : obstacles.at(b)) l[o.node].blocked += static_cast<R>(o.blocked);
    }
  for (const Newborn& n : newborns) {
    const Vec3d cells = (n.position - world.origin) * (1 / world.dx);
    Vec3i block;
    Vec3<R> u;
    for (int a = 0; a < 3; ++a) {
      const double at = cells[a] - 0.5;
      block[a] = (world.low[a] + static_cast<std::int32_t>(std::floor(at))) >> 2;
      u[a] = static_cast<R>(at - (block[a] * block_width - world.low[a]));
    }
    const Stencil<R> stencil = make_stencil(u);
    const auto index_of = [&](int i, int j, int k) {
      const Vec3i at{block.x * 4 + stencil.base[0] + i, block.y * 4 + stencil.base[1] + j,
                     block.z * 4 + stencil.base[2] + k};
      return static_cast<std::size_t>(world.grid.blocks.find(world.wrapped(block_of(at)))) * block_nodes +
             node_index(at.x & 3, at.y & 3, at.z & 3);
    };
    const Vec3<R> q = static_cast<Vec3<R>>(n.velocity) * step.mass;
    Node<R> slope[3];
    for (int a = 0; a < 3; ++a) {
      const auto c = static_cast<Vec3<R>>(n.gradient.column(a) * world.dx) * step.mass;
      slope[a] = {c.x, c.y, c.z, R(0)};
    }
    scatter(stencil, Node<R>{q.x, q.y, q.z, step.mass}, slope,
            [&](int i, int j, int k) -> Node<R>& { return world.grid.nodes[index_of(i, j, k)]; });
    if (!world.grid.liquid.empty())
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k) {
            const R w = stencil.w[0].w[i] * stencil.w[1].w[j] * stencil.w[2].w[k];
            LiquidNode<R>& l = world.grid.liquid[index_of(i, j, k)];
            if (set.liquid)
              l.mass += w * step.mass;
            else
              l.blocked += w * per_cell;
          }
  }
  Materials::with(set.material, [&]<class M>() {
    const auto law = M::template Law<R>::from(set.values);
    typename M::template State<R> rest;
    for (int c = 0; c < state_columns<M>; ++c) rest[c] = static_cast<R>(M::template State<R>::rest[c]);
    const Response<R> r = law.respond(rest);
    stats.wave_speed = static_cast<double>(r.sound_speed);
    stats.viscosity = static_cast<double>(r.kinematic_viscosity);
    stats.j_min = stats.j_max = 1;
  });
  return stats;
}

#define DM_INSTANTIATE(R)                                                                                          \
  template std::vector<Neighbours> neighbours_of(const World<R>&);                                                 \
  template GridStats update_grid(World<R>&, const Obstacles&, double);                                             \
  template BlockWalls<R> block_walls(const World<R>&, const Vec3i&);                                               \
  template SetStep<R> set_step(const World<R>&, const ParticleSet<R>&, double, double);                            \
  template void clear_grid(const World<R>&, const Obstacles&, std::vector<Node<R>>&, std::vector<LiquidNode<R>>&); \
  template PassStats scatter_newborns(World<R>&, std::size_t, std::span<const Newborn>, const Obstacles&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
