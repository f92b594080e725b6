#include "dreampm/pipeline/bench/operations.h"

#include "dreampm/backend/common.h"
#include "dreampm/math/rng.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

/// `size` components of a node.
template <int size>
struct CountedNode {
  Counted c[size];
  friend CountedNode operator+(CountedNode a, const CountedNode& b) {
    for (int i = 0; i < size; ++i) a.c[i] += b.c[i];
    return a;
  }
  friend CountedNode operator*(CountedNode a, const Counted& s) {
    for (Counted& x : a.c) x *= s;
    return a;
  }
  friend CountedNode mul_add(const CountedNode& a, const Counted& s, CountedNode b) {
    for (int i = 0; i < size; ++i) b.c[i] = mul_add(a.c[i], s, b.c[i]);
    return b;
  }
};

/// A row of three nodes that multiplies and adds in one, as vectors do.
template <class N>
struct CountedRow {
  using Node = N;
  struct Weights {
    Counted w[3];
    Weights(const Counted (&weights)[3]) : w{weights[0], weights[1], weights[2]} {}
  };
  N n[3];
  friend CountedRow operator*(const CountedRow& a, const Counted& s) { return {{a.n[0] * s, a.n[1] * s, a.n[2] * s}}; }
  friend CountedRow operator+(const CountedRow& a, const CountedRow& b) {
    return {{a.n[0] + b.n[0], a.n[1] + b.n[1], a.n[2] + b.n[2]}};
  }
  friend CountedRow mul_add(const CountedRow& a, const Counted& s, CountedRow b) {
    for (int i = 0; i < 3; ++i) b.n[i] = mul_add(a.n[i], s, b.n[i]);
    return b;
  }
  static CountedRow spread(const N& node, const Weights& w) { return {{node * w.w[0], node * w.w[1], node * w.w[2]}}; }
  friend N collapse(const CountedRow& a, const Weights& w) {
    return mul_add(a.n[2], w.w[2], mul_add(a.n[1], w.w[1], a.n[0] * w.w[0]));
  }
};

template <class M>
OperationCount count(const World<float>& world) {
  const ParticleSet<float>& set = world.sets.front();
  const auto law = M::template Law<float>::from(set.values);
  const SetStep<float> step = set_step(world, set, world.dt_next, world.dt_next);
  const BlockWalls<float> walls = block_walls(world, world.particle_blocks.front());
  OperationCount counts;
  auto number = [&, i = std::uint64_t{0}](double middle, double range) mutable {
    return Counted(static_cast<float>(middle + range * (uniform(1, i++) - 0.5)), &counts);
  };
  typename M::template State<Counted> state;
  for (int c = 0; c < state_columns<M>; ++c) state[c] = number(M::template State<float>::rest[c], 1e-3);
  Vec3<Counted> u{number(1.5, 1), number(1.5, 1), number(1.5, 1)};
  // The mass is gathered where the law asks for a density.
  constexpr int gathered = M::wants_density ? 4 : 3;
  using In = CountedRow<CountedNode<gathered>>;
  using Out = CountedRow<CountedNode<4>>;
  In nodes;
  for (auto& node : nodes.n)
    for (int i = 0; i < gathered; ++i) node.c[i] = i < 3 ? number(0, 0.1) : number(step.full_mass, step.full_mass / 8);

  const Moments<CountedNode<gathered>> m = gather<In>(make_stencil(u), [&](int, int) { return nodes; });
  Gathered<Counted> g;
  for (int i = 0; i < 3; ++i) {
    g.v[i] = m.value.c[i];
    for (int a = 0; a < 3; ++a) g.along[a][i] = m.along[a].c[i];
  }
  if constexpr (M::wants_density) g.mass = m.value.c[3];
  Response<Counted> response;
  bool pushed = false;
  const Scattered<Counted> s = particle_step<M, Counted>(law, step, walls, g, u, state, response, pushed);
  kinetic_energy(g, s, step);

  CountedNode<4> q{{s.q.x, s.q.y, s.q.z, Counted(step.mass)}}, slope[3];
  for (int a = 0; a < 3; ++a) slope[a] = {{s.slope[a].x, s.slope[a].y, s.slope[a].z, Counted()}};
  Out sum;
  for (auto& node : sum.n)
    for (Counted& x : node.c) x = number(0, 1);
  scatter<Out>(make_stencil(u), q, slope, [&](int, int, const Out& row) { sum = sum + row; });
  return counts;
}

}  // namespace

OperationCount operations_of(const World<float>& world) {
  OperationCount counts;
  Materials::with(world.sets.at(0).material, [&]<class M>() { counts = count<M>(world); });
  return counts;
}

double bytes_moved_of(const World<float>& world) {
  const Carried<float>& grid = world.grid;
  double bytes = static_cast<double>(grid.nodes.size() + grid.solids.size()) * sizeof(Node<float>);
  bytes += static_cast<double>(grid.liquid.size()) * sizeof(LiquidNode<float>);
  for (const auto& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      bytes += static_cast<double>(set.size()) * sizeof(float) * static_cast<double>(3 + state_columns<M>);
    });
  return 2 * bytes / static_cast<double>(world.particles());
}

}  // namespace dreampm
