#include "bench/operations.h"

#include "dreampm/backend/common.h"
#include "dreampm/math/rng.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

template <class M>
OperationCount count(const World<float>& world) {
  const ParticleSet<float>& set = world.sets.front();
  const auto law = M::template Law<float>::from(set.values);
  SetStep<float> step = set_step(world, set, world.dt_next, world.dt_next);
  // Most steps relax no volume.
  step.volume_relaxation = 0;
  const BlockWalls<float> walls = block_walls(world, world.particle_blocks[world.particle_blocks.size() / 2], false);
  OperationCount counts;
  auto number = [&, i = std::uint64_t{0}](double middle, double range) mutable {
    return Counted(static_cast<float>(middle + range * (uniform(1, i++) - 0.5)), &counts);
  };
  typename M::template State<Counted> state;
  for (int c = 0; c < state_columns<M>; ++c) state[c] = number(M::template State<float>::rest[c], 1e-3);
  Vec3<Counted> u{number(1.5, 1), number(1.5, 1), number(1.5, 1)};
  // One component after the other, as lanes do; the mass where the law asks for a density in every
  // step.
  const Stencil<Counted> from = make_stencil(u);
  const Shared<Counted, 3> x(from.w[0], from.t[0]), y(from.w[1], from.t[1]);
  const LinePlace<Counted> z(from.t[2]);
  const auto row_of = [&](double middle, double range) {
    return [=, &number](int, int) {
      return LineSpline<Counted>{number(middle, range), number(0, range), number(0, range)};
    };
  };
  G2PResult<Counted> g;
  const auto gather_one = [&]<int c>() {
    const Moments<Counted> m = gather<Counted, M::info.liquid ? bend_along(c) : no_bends>(x, y, z, row_of(0, 0.1));
    g.v[c] = m.value;
    for (int a = 0; a < 3; ++a) g.affine_moment[a][c] = m.first_moment[a];
    if constexpr (M::info.liquid) g.affine_excess = mul_add(m.bend[c], affine_excess(from.t[c]), g.affine_excess);
  };
  gather_one.template operator()<0>(), gather_one.template operator()<1>(), gather_one.template operator()<2>();
  const double full = static_cast<double>(step.full);
  if (measures<M>(step.volume_relaxation)) g.node_content = gather_value<Counted>(x, y, z, row_of(full, full / 8));
  StressResponse<Counted> response;
  bool pushed = false;
  const P2GTerms<Counted> s = particle_step<M, Counted>(law, step, walls, g, u, state, response, pushed);
  kinetic_energy(g, s, step);

  // The mass of a particle is the same everywhere: it has no slopes.
  const Stencil<Counted> to = make_stencil(u);
  for (int i = 0; i < 4; ++i) {
    const Counted q = i < 3 ? s.q[i] : Counted(step.mass);
    const Counted slope[3] = {i < 3 ? s.slope[0][i] : Counted(), i < 3 ? s.slope[1][i] : Counted(),
                              i < 3 ? s.slope[2][i] : Counted()};
    Counted node = number(0, 1);
    scatter(to, q, slope, [&](int, int, int) -> Counted& { return node; });
  }
  return counts;
}

}  // namespace

OperationCount operations_of(const World<float>& world) {
  OperationCount counts;
  Materials::with(world.sets.at(0).material, [&]<class M>() { counts = count<M>(world); });
  return counts;
}

double bytes_moved_of(const World<float>& world) {
  const GridFields<float>& grid = world.grid;
  double bytes =
      static_cast<double>(grid.nodes.size() + grid.solids.size() + grid.mixture.size()) * sizeof(Node<float>);
  for (const auto& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      bytes += static_cast<double>(set.size()) * sizeof(float) * static_cast<double>(3 + state_columns<M>);
    });
  return 2 * bytes / static_cast<double>(world.particles());
}

}  // namespace dreampm
