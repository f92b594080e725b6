#include "dreampm/backend/scatter_particles.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "dreampm/backend/common.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/four.h"
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

/// A node in a register.
template <class R>
struct FourOfNode {
  Four<R> v;
  FourOfNode() = default;
  FourOfNode(const Four<R>& all) : v(all) {}
  FourOfNode(R x, R y, R z, R m) : v{x, y, z, m} {}
  friend FourOfNode operator+(const FourOfNode& a, const FourOfNode& b) { return a.v + b.v; }
  friend FourOfNode operator-(const FourOfNode& a, const FourOfNode& b) { return a.v - b.v; }
  friend FourOfNode operator*(const FourOfNode& a, R s) { return a.v * s; }
  friend FourOfNode mul_add(const FourOfNode& a, R s, const FourOfNode& b) { return a.v * s + b.v; }
};

/// The nodes that a block of particles reaches, in rows: they are the grid's while no other block
/// writes them.
template <class R>
class ReachedNodes {
 public:
  ReachedNodes(const NodesToAddTo<R>& grid, const StencilBlocks& blocks) : grid_(grid), blocks_(blocks) {
    for_fields([&](auto* near, Node<R>* field) { copy(near, field, true); });
  }
  void put_back() {
    for_fields([&](auto* near, Node<R>* field) { copy(near, field, false); });
  }
  NodesToAddTo<R, FourOfNode<R>> to() {
    return {own_, grid_.stress ? stress_ : nullptr, grid_.velocity_old ? velocity_old_ : nullptr,
            grid_.mixture ? mixture_ : nullptr};
  }
  static constexpr std::size_t index(const Vec3i& n) {
    return static_cast<std::size_t>((n.x * width + n.y) * width + n.z);
  }
  /// True if no block comes twice, as blocks do on periodic axes of one block.
  static bool suit(const StencilBlocks& blocks) {
    for (std::size_t n = 0; n < blocks.size(); ++n)
      if (blocks[n] != BlockList::none && std::find(blocks.begin() + n + 1, blocks.end(), blocks[n]) != blocks.end())
        return false;
    return true;
  }

 private:
  static constexpr int width = 2 * block_width, count = width * width * width;
  template <class Body>
  void for_fields(const Body& body) {
    body(own_, grid_.own);
    if (grid_.stress) body(stress_, grid_.stress);
    if (grid_.velocity_old) body(velocity_old_, grid_.velocity_old);
    if (grid_.mixture) body(mixture_, grid_.mixture);
  }
  template <class N>
  void copy(N* near, Node<R>* field, bool in) const {
    static_assert(sizeof(N) == sizeof(Node<R>));
    for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) {
      const std::int32_t block = blocks_[static_cast<std::size_t>(b)];
      const Vec3i first = stencil_block_offset(b) * block_width;
      for (int row = 0; block != BlockList::none && row < block_width * block_width; ++row) {
        N* const at = near + index(first + Vec3i{row / block_width, row % block_width, 0});
        Node<R>* const there = field + static_cast<std::size_t>(block) * block_nodes + row * block_width;
        if (in)
          std::memcpy(static_cast<void*>(at), there, block_width * sizeof(N));
        else
          std::memcpy(static_cast<void*>(there), at, block_width * sizeof(N));
      }
    }
  }

  NodesToAddTo<R> grid_;
  const StencilBlocks& blocks_;
  FourOfNode<R> own_[count], stress_[count], velocity_old_[count];
  Node<R> mixture_[count];
};

}  // namespace

template <class R>
PassStats state_bounds(const World<R>& world) {
  /// The bounds among PassStats.
  struct Bounds {
    double wave_speed = 0, viscosity = 0, j_min = PassStats{}.j_min, j_max = PassStats{}.j_max;
    bool finite = true;
  };
  const auto widen = [](Bounds& to, const Bounds& by) {
    to.wave_speed = std::max(to.wave_speed, by.wave_speed), to.viscosity = std::max(to.viscosity, by.viscosity);
    to.j_min = std::min(to.j_min, by.j_min), to.j_max = std::max(to.j_max, by.j_max);
    to.finite = to.finite && by.finite;
  };
  Bounds all;
  for (const ParticleSet<R>& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      const auto law = M::template Law<R>::from(set.values);
      const auto of_particle = [&](Bounds& to, std::size_t p) {
        const auto state = state_of<M>(set, p);
        const StressResponse<R> r = law.respond(state);
        const auto c = static_cast<double>(r.sound_speed), j = static_cast<double>(volume_ratio(law, state));
        widen(to, {c, static_cast<double>(r.kinematic_viscosity), j, j, std::isfinite(c + j)});
      };
      widen(all, parallel_reduce(set.size(), Bounds{}, of_particle, widen));
    });
  PassStats stats;
  stats.wave_speed = all.wave_speed, stats.viscosity = all.viscosity;
  stats.j_min = all.j_min, stats.j_max = all.j_max, stats.finite = all.finite;
  return stats;
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
      const NodesToAddTo<R> to = nodes_to_add_to(world, set);
      // Nodes count from one before first_stencil() of the block, where its grid block begins.
      const auto add = [&](std::size_t p, const auto& nodes, const auto& index) {
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
        const Vec3i first{stencil.node(0) + 1, stencil.node(1) + 1, stencil.node(2) + 1};
        add_particle(world, set, step, stencil, terms, nodes,
                     [&](int i, int j, int k) { return index(first, i, j, k); });
      };
      const auto add_block = [&](std::size_t b) {
        const std::uint32_t begin = set.block_start[b], end = set.block_start[b + 1];
        const StencilBlocks& blocks = stencil_blocks[b];
        if (begin == end) return;
        if (ReachedNodes<R>::suit(blocks)) {
          ReachedNodes<R> near(to, blocks);
          for (std::uint32_t p = begin; p < end; ++p)
            add(p, near.to(), [](const Vec3i& first, int i, int j, int k) {
              return ReachedNodes<R>::index(first) + ReachedNodes<R>::index({i, j, k});
            });
          return near.put_back();
        }
        for (std::uint32_t p = begin; p < end; ++p)
          add(p, to, [&](const Vec3i& first, int i, int j, int k) {
            const Vec3i n = first + Vec3i{i, j, k};
            const int of = (n.x >> 2) * 4 + (n.y >> 2) * 2 + (n.z >> 2);
            return static_cast<std::size_t>(blocks[static_cast<std::size_t>(of)]) * block_nodes +
                   static_cast<std::size_t>(node_index(n.x & 3, n.y & 3, n.z & 3));
          });
      };
      for (const auto& blocks : colors) parallel_for(blocks.size(), 4, [&](std::size_t i) { add_block(blocks[i]); });
    });
  }
}

template PassStats state_bounds(const World<float>&);
template PassStats state_bounds(const World<double>&);
template void scatter_particles(World<float>&, const Motion<float>&, const Obstacles&);
template void scatter_particles(World<double>&, const Motion<double>&, const Obstacles&);

}  // namespace dreampm
