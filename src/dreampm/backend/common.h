// Functions that all backends share, in plain loops: visits of nodes and insertion of particles.
#pragma once
#include <algorithm>
#include <memory>
#include <optional>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/mirror_walls.h"
#include "dreampm/backend/node_loops.h"
#include "dreampm/backend/pass_limits.h"
#include "dreampm/contact/obstacles.h"
#include "dreampm/physics/particle.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {

/// The grid's blocks that every block of particles reaches, in the memory of `all`.
template <class R>
void find_stencil_blocks(const World<R>& world, std::vector<StencilBlocks>& all);
/// True if a collider is within reach of the particles of a block that reaches those.
inline bool colliders_near(const Obstacles& obstacles, const StencilBlocks& stencil_blocks) {
  return obstacles.any() && std::any_of(stencil_blocks.begin(), stencil_blocks.end(), [&](std::int32_t b) {
           return b != BlockList::none && obstacles.near(static_cast<std::size_t>(b));
         });
}

/// The colliders near one block of particles that are too thin for the splines between the nodes.
class ThinWalls {
 public:
  /// Finds them for the block of particles that reaches these blocks of the grid.
  ThinWalls(const Obstacles& obstacles, const StencilBlocks& stencil_blocks) {
    if (!obstacles.any_thin()) return;
    for (std::size_t n = 0; n < stencil_blocks.size(); ++n) {
      if (stencil_blocks[n] != BlockList::none)
        blocks_[n] = obstacles.thin(static_cast<std::size_t>(stencil_blocks[n]));
      any_ = any_ || blocks_[n];
    }
  }
  bool any() const { return any_; }
  /// The gradient of the distance from colliders, and that distance [cells], at most `reach`, at a
  /// particle at `u`; nothing where the splines will do.
  template <class R>
  std::optional<Node<R>> at(const Vec3<R>& u, double reach = ColliderContact::clearance_reach) const {
    // A particle's place counts from half a cell behind the second node that its block reaches.
    const Vec3d place = static_cast<Vec3d>(u) + Vec3d{1.5, 1.5, 1.5};
    const Vec3i cell{static_cast<int>(place.x), static_cast<int>(place.y), static_cast<int>(place.z)};
    const Vec3i side{cell.x >> 2, cell.y >> 2, cell.z >> 2};
    const Obstacles::Thin* const thin = blocks_[static_cast<std::size_t>(side.x * 4 + side.y * 2 + side.z)];
    if (!thin || !(thin->cells >> node_index(cell.x & 3, cell.y & 3, cell.z & 3) & 1)) return {};
    const ColliderDistance d = thin->view.nearest_exposed(place - static_cast<Vec3d>(side * block_width), reach);
    return Node<R>{static_cast<R>(d.normal.x), static_cast<R>(d.normal.y), static_cast<R>(d.normal.z),
                   static_cast<R>(d.distance)};
  }
  /// The same, with `no_distance` where the splines will do.
  Node<float> or_none(const Vec3<float>& u) const { return at(u).value_or(Node<float>{0, 0, 0, no_distance}); }
  /// Fills columns for the particles of a block, [begin, end), with or_none(u).
  template <class Columns>
  void fill(const std::array<const float*, 3>& u, std::size_t begin, std::size_t end, Columns& to) const {
    for (std::size_t p = begin; p < end; ++p) {
      const Node<float> d = or_none({u[0][p], u[1][p], u[2][p]});
      to[0][p] = d.x, to[1][p] = d.y, to[2][p] = d.z, to[3][p] = d.m;
    }
  }

 private:
  std::array<const Obstacles::Thin*, 8> blocks_{};
  bool any_ = false;
};

template <class R>
class SurfaceContact;

/// grid_update for all blocks, and the stages of viscosity after it, in parallel, with sums in the
/// order of the blocks. Keeps the memory that it works with from one step to the next.
template <class R>
class GridUpdate {
 public:
  explicit GridUpdate(const NodeLoops<R>& loops = plain_node_loops<R>());
  ~GridUpdate();
  /// Must be called after every change of the grid's block list.
  void prepare(const World<R>& world, const Obstacles& obstacles);
  /// Must be called after colliders have moved, if nothing else changed.
  void colliders_moved(const World<R>& world, const Obstacles& obstacles);
  GridStats operator()(World<R>& world, const Obstacles& obstacles, double dt);
  /// Sub-cycles viscosity as in Backend::sub_cycle. `forces()` fills the fields of `momenta`, which
  /// are as long as the world's, with the momentum that the viscous stress of the present
  /// velocities would give in all of dt. `fastest()`: the largest speed that particles gather
  /// [m/s]. Nodes do not show it here: one at the rim with a thousandth of a particle's mass goes
  /// with the stress beside it for as long as the step is.
  template <class Forces, class Speed>
  double sub_cycle(World<R>& world, const Obstacles& obstacles, double dt, GridStats& found,
                   const GridFields<R>& momenta, const Forces& forces, const Speed& fastest) {
    begin_stages(world, found);
    for (int stage = 1; stage <= world.viscous_stages; ++stage) {
      forces();
      run_stage(world, obstacles, dt, stage, momenta);
    }
    found.max_speed = fastest();
    return end_stages(world, found);
  }
  const MirrorWalls<R>& images() const;
  ContactGaps& gaps();
  const SurfaceContact<R>& surfaces() const;

 private:
  void begin_stages(const World<R>& world, const GridStats& found);
  void run_stage(World<R>& world, const Obstacles& obstacles, double dt, int stage, const GridFields<R>& momenta);
  double end_stages(const World<R>& world, GridStats& found);

  struct Work;
  std::unique_ptr<Work> work_;
};

/// Scatters mass, momentum and C of seeds that are inserted, and measures the bounds of the rest
/// state.
template <class R>
PassStats scatter_seeds(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds,
                        const Obstacles& obstacles);
/// The same without the colliders' share of new blocks of the mixture. Looks at no nodes but those
/// that the seeds reach.
template <class R>
PassStats add_seeds(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds);

/// The walls of the box for particles of `block`. `colliders`: whether there are any about.
template <class R>
BlockWalls<R> block_walls(const World<R>& world, const Vec3i& block, bool colliders);

template <class R>
SetStep<R> set_step(const World<R>& world, const ParticleSet<R>& set, double dt, double dt_next);

/// Makes the fields of `next` as long as the world's. The block list is left alone.
template <class R>
void fit_grid(const World<R>& world, GridFields<R>& next);
/// Adds the colliders' share to the mixture at the nodes of a block.
template <class R>
void add_colliders(const World<R>& world, const Obstacles& obstacles, std::size_t block, Node<R>* nodes);
/// Zeroes one of its blocks, and fills in the colliders' share of the mixture.
template <class R>
void clear_block(const World<R>& world, const Obstacles& obstacles, GridFields<R>& next, std::size_t block);

/// Empties the grid of the step to come, but for the colliders' share of the mixture, and adds the
/// images of masses behind walls to the world's: what comes before a pass that zeroes no block by
/// itself.
template <class R>
void begin_pass(World<R>& world, const Obstacles& obstacles, const MirrorWalls<R>& images, GridFields<R>& next,
                double dt);

/// Exchanges all fields of two grids, not their block lists.
template <class R>
void swap_fields(GridFields<R>& a, GridFields<R>& b);

}  // namespace dreampm
