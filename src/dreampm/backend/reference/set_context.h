// The data that loops over one set of particles work with.
#pragma once
#include <cstddef>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/reference/particle_nodes.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/particle_state.h"

namespace dreampm::reference {

/// The surroundings of particles, by block of particles.
struct Surroundings {
  Obstacles obstacles;
  std::vector<StencilBlocks> blocks;  ///< of the grid, that the particles reach
  std::vector<ThinWalls> thin_walls;

  /// Must be called after every change of the block lists.
  template <class R>
  void prepare(const World<R>& world) {
    obstacles.prepare(world);
    find_stencil_blocks(world, blocks);
    thin_walls.clear();
    for (const StencilBlocks& reached : blocks) thin_walls.emplace_back(obstacles, reached);
  }
  bool colliders_near(std::size_t block) const { return dreampm::colliders_near(obstacles, blocks[block]); }
};

/// One set of particles in a pass: what it reads, and the grid that it writes.
template <class R>
struct SetContext {
  SetContext(const World<R>& w, ParticleSet<R>& s, const Surroundings& a, GridFields<R>& n, double dt, double dt_next)
      : world(w),
        set(s),
        around(a),
        next(n),
        step(set_step(w, s, dt, dt_next)),
        field(w.field_of(s)),
        by_volume(w.measures_by_volume(field)) {}

  const World<R>& world;
  ParticleSet<R>& set;
  const Surroundings& around;
  GridFields<R>& next;  ///< of the step to come
  const SetStep<R> step;
  const std::size_t field;  ///< which of the grid's fields the set moves in
  const bool by_volume;     ///< whether a density in it is measured by volume

  const Nodes<R>& velocities() const { return world.grid.field(field); }
  Vec3<R> position(std::size_t p) const { return {set.u[0][p], set.u[1][p], set.u[2][p]}; }
  ParticleNodes<R> nodes_of(std::size_t block, std::size_t p) const { return {around.blocks[block], position(p)}; }
  BlockWalls<R> walls_of(std::size_t block) const {
    return block_walls(world, world.particle_blocks[block], around.colliders_near(block));
  }
  template <class M>
  typename M::template State<R> state(std::size_t p) const {
    return state_of<M>(set, p);
  }

  template <class M>
  void store(std::size_t p, const Vec3<R>& u, typename M::template State<R>& state) const {
    for (std::size_t a = 0; a < 3; ++a) set.u[a][p] = u[static_cast<int>(a)];
    for (int c = 0; c < state_columns<M>; ++c) set.state[static_cast<std::size_t>(c)][p] = state[c];
  }

  /// Calls body(block, particle) for each particle.
  template <class Body>
  void for_each_particle(const Body& body) const {
    for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) body(b, p);
  }
};

/// One particle between the phases of a pass.
template <class R>
struct PassParticle {
  G2PResult<R> gathered;
  StressResponse<R> response;
  R volume_ratio;  ///< J
  P2GTerms<R> scattered;
};

}  // namespace dreampm::reference
