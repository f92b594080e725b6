#include "dreampm/backend/scatter_particles.h"

#include <algorithm>
#include <map>

#include "dreampm/backend/common.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/neighbors.h"
#include "dreampm/state/particle_state.h"

namespace dreampm {
namespace {

/// Particle blocks in groups whose members write no common block of the grid: a block writes itself
/// and the next one along each axis. Where a periodic axis has an odd number of blocks, its last
/// one is a color of its own.
template <class R>
std::vector<std::vector<std::uint32_t>> colors_of(const World<R>& world) {
  std::map<int, std::vector<std::uint32_t>> colors;
  for (std::size_t b = 0; b < world.particle_blocks.size(); ++b) {
    int color = 0;
    for (int a = 0; a < 3; ++a) {
      const std::int32_t at = world.particle_blocks[b][a], first = world.low[a] / block_width,
                         count = (world.high[a] - world.low[a]) / block_width;
      const bool seam = world.periodic[static_cast<std::size_t>(a)] && count % 2 == 1 && at == first + count - 1;
      color = 3 * color + (seam ? 2 : at & 1);
    }
    colors[color].push_back(static_cast<std::uint32_t>(b));
  }
  std::vector<std::vector<std::uint32_t>> groups;
  for (auto& [color, blocks] : colors) groups.push_back(std::move(blocks));
  return groups;
}

}  // namespace

template <class R>
PassStats state_bounds(const World<R>& world) {
  PassStats all;
  for (const ParticleSet<R>& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      const auto law = M::template Law<R>::from(set.values);
      const auto of_particle = [&](PassStats& sum, std::size_t p) {
        const auto state = state_of<M>(set, p);
        const StressResponse<R> r = law.respond(state);
        const double j = static_cast<double>(volume_ratio(law, state));
        PassStats one;
        one.wave_speed = static_cast<double>(r.sound_speed);
        one.viscosity = static_cast<double>(r.kinematic_viscosity);
        one.j_min = one.j_max = j;
        one.finite = std::isfinite(one.wave_speed + j);
        sum.add(one);
      };
      all.add(parallel_reduce(set.size(), PassStats{}, of_particle,
                              [](PassStats& to, const PassStats& from) { to.add(from); }));
    });
  return all;
}

template <class R>
void scatter_particles(World<R>& world, const Motion<R>& motion, const Obstacles& obstacles) {
  GridFields<R>& grid = world.grid;
  fit_grid(world, grid);
  parallel_for(grid.blocks.size(), 32, [&](std::size_t b) { clear_block(world, obstacles, grid, b); });
  std::vector<StencilBlocks> stencil_blocks;
  find_stencil_blocks(world, stencil_blocks);
  const auto colors = colors_of(world);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    if (set.size() == 0) continue;
    const SetStep<R> step = set_step(world, set, world.dt_next, world.dt_next);
    Materials::with(set.material, [&]<class M>() {
      const auto law = M::template Law<R>::from(set.values);
      const auto add = [&](std::size_t b, std::size_t p) {
        const auto state = state_of<M>(set, p);
        const Mat3<R>& c = motion.sets[s].gradient[p];
        StressResponse<R> response = law.respond(state);
        if (!step.sub_cycled) add_viscous(law, state, StrainIncrement<R>{c * step.dt, step.dt, R(1), R(0)}, response);
        ParticleTerms<R> terms;
        terms.momentum = motion.sets[s].velocity[p] * step.mass;
        for (int a = 0; a < 3; ++a) terms.affine[a] = c.column(a) * (step.dx * step.mass * step.transfer.affine);
        stress_slopes(step, response.tau, step.dt_next, terms.stress);
        terms.viscosity = response.kinematic_viscosity + response.implicit_viscosity;
        terms.volume_ratio = volume_ratio(law, state);
        const Stencil<R> stencil = make_stencil(Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]});
        // Nodes count from one before first_stencil() of the block, where its grid block begins.
        add_particle(world, set, step, stencil, terms, [&](int i, int j, int k) {
          const Vec3i n{stencil.node(0) + i + 1, stencil.node(1) + j + 1, stencil.node(2) + k + 1};
          const int of = (n.x >> 2) * 4 + (n.y >> 2) * 2 + (n.z >> 2);
          return static_cast<std::size_t>(stencil_blocks[b][static_cast<std::size_t>(of)]) * block_nodes +
                 node_index(n.x & 3, n.y & 3, n.z & 3);
        });
      };
      for (const auto& blocks : colors)
        parallel_for(blocks.size(), 4, [&](std::size_t i) {
          const std::size_t b = blocks[i];
          for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) add(b, p);
        });
    });
  }
}

template PassStats state_bounds(const World<float>&);
template PassStats state_bounds(const World<double>&);
template void scatter_particles(World<float>&, const Motion<float>&, const Obstacles&);
template void scatter_particles(World<double>&, const Motion<double>&, const Obstacles&);

}  // namespace dreampm
