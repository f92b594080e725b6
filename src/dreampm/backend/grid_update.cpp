// The one visit of every grid node in a step, and the stages of viscosity after it.
#include <algorithm>
#include <cmath>

#include "dreampm/backend/block_visit.h"
#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/flush_to_zero.h"
#include "dreampm/backend/stage_sums.h"
#include "dreampm/backend/surface_contact.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/thread_team.h"

namespace dreampm {
namespace {

constexpr std::size_t blocks_at_once = 8, blocks_a_sum = 32;

/// The total of one of BlockStats's sources.
ImpulseSum& impulse_of(GridStats& total, std::size_t source) {
  using enum BlockStats::Source;
  if (source >= first_collider) return total.colliders[source - first_collider];
  return source == damping ? total.damping : source == fields ? total.fields : total.walls[source - first_wall];
}

}  // namespace

ImpulseSum GridStats::contact() const {
  ImpulseSum all;
  for (const ImpulseSum& p : walls) all += p;
  for (const ImpulseSum& p : colliders) all += p;
  return all;
}

template <class R>
struct GridUpdate<R>::Work {
  explicit Work(const NodeLoops<R>& with) : loops(with) {}

  NodeLoops<R> loops;
  MirrorWalls<R> images;
  SurfaceContact<R> surfaces;
  ContactGaps gaps;
  std::vector<std::uint32_t> deferred_blocks;  ///< blocks whose contact has to wait for the results of others
  // Arrays by block.
  std::vector<std::uint64_t> at_walls;
  std::vector<BlockStats> block_stats;
  std::vector<GridStats> sums;  ///< of blocks_a_sum blocks each
  // Impulses of force fields; empty without any.
  std::array<std::vector<Vec3<R>>, 2> field_impulses;  ///< kg m/s, by field and node
  // State of the viscous stages.
  std::array<Nodes<R>, 2> old, change;  ///< see RklStage
  StageSums stages;

  /// Visits every block: first(visit of a block), contact, last(visit of a block). `measure`: true
  /// to measure the gaps anew.
  template <class First, class Last>
  GridStats visit(World<R>& world, const Obstacles& obstacles, const NodeStep<R>& step, bool measure,
                  const First& first, const Last& last);
  /// True if contact in that block has to wait for the results of other blocks.
  bool waits(std::size_t block) const { return images.changes(block) || surfaces.changes(block); }
  /// Adds up the results of some blocks in their order.
  void add_up(const World<R>& world, std::size_t some);
  GridStats total(const World<R>& world);
  void clear_field_impulses(const World<R>& world);
  /// Returns the work of force fields [J], after all else in the step has acted: their impulse at
  /// the velocity that moves the matter. Fields act on velocities that hold the impulse of stress,
  /// but not yet that of walls and images. Where all these hold matter against a field nothing
  /// moves, and with the velocity of the moment the square of an impulse would count as work in
  /// every step.
  double field_work(const World<R>& world);
};

template <class R>
void GridUpdate<R>::Work::clear_field_impulses(const World<R>& world) {
  for (std::size_t f = 0; f < 2; ++f)
    field_impulses[f].assign(world.fields.empty() ? 0 : world.grid.field(f).size(), {});
}

template <class R>
double GridUpdate<R>::Work::field_work(const World<R>& world) {
  const FieldSteps<R> fields(world, 0);  // for where they act
  if (!fields.any()) return 0;
  const auto add_block = [&](double& sum, std::size_t b) {
    if (!fields.any_in(world, world.grid.blocks[b])) return;
    for (std::size_t f = 0; f < 2; ++f) {
      const Nodes<R>& nodes = world.grid.field(f);
      if (nodes.empty()) continue;
      for (std::size_t i = b * block_nodes; i < (b + 1) * block_nodes; ++i)
        if (!(field_impulses[f][i] == Vec3<R>{}))
          sum += static_cast<double>(dot(field_impulses[f][i], velocity(nodes[i])));
    }
  };
  return parallel_reduce(world.grid.blocks.size(), 0.0, add_block);
}

template <class R>
template <class First, class Last>
GridStats GridUpdate<R>::Work::visit(World<R>& world, const Obstacles& obstacles, const NodeStep<R>& step, bool measure,
                                     const First& first, const Last& last) {
  const std::size_t blocks = world.grid.blocks.size();
  const bool all_deferred = deferred_blocks.size() == blocks;
  parallel_region([&](ThreadTeam& team) {
    const FlushToZero mode;
    const auto block = [&](std::size_t b) {
      return BlockVisit<R>(step, loops, world, obstacles, gaps, b, at_walls[b], block_stats[b]);
    };
    if (measure) gaps.measure(team, world, obstacles);
    team.loop(blocks, blocks_at_once, [&](std::size_t b) {
      BlockVisit<R> one = block(b);
      first(one);
      if (!all_deferred && !waits(b)) one.apply_boundaries();
    });
    surfaces.of_all_fields(team, world, obstacles, gaps, step.per_dt, block_stats);
    images.fold_ghosts(team, world, loops, gaps);
    if (!world.grid.solids.empty())
      team.loop(deferred_blocks.size(), blocks_at_once,
                [&](std::size_t i) { block(deferred_blocks[i]).apply_two_field_contact(); });
    team.loop(deferred_blocks.size(), blocks_at_once,
              [&](std::size_t i) { block(deferred_blocks[i]).apply_boundaries(); });
    images.reflect_ghosts(team, world, loops);
    team.loop(sums.size(), 1, [&](std::size_t some) { add_up(world, some); });
    last(team, block);
  });
  return total(world);
}

template <class R>
void GridUpdate<R>::Work::add_up(const World<R>& world, std::size_t some) {
  GridStats& total = sums[some];
  total = {};
  total.colliders.resize(world.colliders.size());
  const std::size_t begin = some * blocks_a_sum, end = std::min(world.grid.blocks.size(), begin + blocks_a_sum);
  for (std::size_t b = begin; b < end; ++b) {
    const NodeSums& s = block_stats[b].sums;
    total.max_speed = std::max(total.max_speed, std::sqrt(s.fastest2));
    total.mass += s.mass;
    total.kinetic += 0.5 * s.kinetic2;
    total.arrived += 0.5 * block_stats[b].arrived2;
    total.moment += world.node_position(world.grid.blocks[b] * block_width) * s.mass + s.moment * world.dx;
    total.finite = total.finite && s.finite;
    for (const auto& [source, sum] : block_stats[b].impulses) impulse_of(total, source) += sum;
  }
}

template <class R>
GridUpdate<R>::GridUpdate(const NodeLoops<R>& loops) : work_(std::make_unique<Work>(loops)) {}
template <class R>
GridUpdate<R>::~GridUpdate() = default;

template <class R>
const MirrorWalls<R>& GridUpdate<R>::images() const {
  return work_->images;
}

template <class R>
ContactGaps& GridUpdate<R>::gaps() {
  return work_->gaps;
}

template <class R>
const SurfaceContact<R>& GridUpdate<R>::surfaces() const {
  return work_->surfaces;
}

template <class R>
void GridUpdate<R>::prepare(const World<R>& world, const Obstacles& obstacles) {
  const std::size_t blocks = world.grid.blocks.size();
  work_->images.prepare(world);
  work_->surfaces.prepare(world, obstacles);
  work_->gaps.prepare(world, obstacles);
  work_->block_stats.resize(std::max(work_->block_stats.size(), blocks));
  work_->sums.resize((blocks + blocks_a_sum - 1) / blocks_a_sum);
  // If solids have a field of their own, a block reads the masses of its neighbors.
  const bool all = !world.grid.solids.empty();
  work_->deferred_blocks.clear();
  work_->at_walls.clear();
  const bool everywhere = world.settings.damping > 0 || !world.fields.empty();
  for (std::size_t b = 0; b < blocks; ++b) {
    work_->at_walls.push_back(nodes_at_walls(world, world.grid.blocks[b]));
    // So that no step takes memory.
    if (everywhere || work_->at_walls.back() || !obstacles.at(b).empty())
      work_->block_stats[b].impulses.reserve(BlockStats::first_collider + world.colliders.size());
    if (all || work_->waits(b)) work_->deferred_blocks.push_back(static_cast<std::uint32_t>(b));
  }
}

template <class R>
void GridUpdate<R>::colliders_moved(const World<R>& world, const Obstacles& obstacles) {
  if (obstacles.changed() || !work_->surfaces.set_velocities(world, obstacles)) prepare(world, obstacles);
}

template <class R>
GridStats GridUpdate<R>::operator()(World<R>& world, const Obstacles& obstacles, double dt) {
  const NodeStep<R> step(world, dt, world.viscous_stages == 0);
  Work& w = *work_;
  w.clear_field_impulses(world);
  w.surfaces.begin_bodies(world, dt);
  GridStats found = w.visit(
      world, obstacles, step, true, [&](BlockVisit<R>& block) { block.momentum_to_velocity(w.field_impulses); },
      [](ThreadTeam&, const auto&) {});
  w.surfaces.end_bodies();
  found.fields.work = w.field_work(world);
  return found;
}

template <class R>
void GridUpdate<R>::begin_stages(const World<R>& world, const GridStats& found) {
  Work& w = *work_;
  w.stages.begin(world.colliders.size(), found);
  for (std::size_t f = 0; f < 2; ++f) {
    const std::size_t nodes = world.grid.field(f).size();
    w.old[f].resize(nodes), w.change[f].assign(nodes, {});
  }
}

template <class R>
void GridUpdate<R>::run_stage(World<R>& world, const Obstacles& obstacles, double dt, int stage,
                              const GridFields<R>& momenta) {
  Work& w = *work_;
  const RklFactors factors(world.viscous_stages, stage);
  // Later stages keep a part of a stage's change: the gains are the parts that add up to the whole
  // step.
  const NodeStep<R> step(world, dt, factors.gain);
  const RklStage<R> now{static_cast<R>(factors.kept),
                        static_cast<R>(factors.gain),
                        factors.part,
                        static_cast<Vec3<R>>(world.gravity_over(dt) * dt),
                        momenta,
                        w.old,
                        w.change};
  GridStats stats = w.visit(
      world, obstacles, step, false, [&](BlockVisit<R>& block) { block.rkl_stage(now); },
      [&](ThreadTeam& team, const auto& block) {
        team.loop(world.grid.blocks.size(), blocks_at_once, [&](std::size_t b) { block(b).store_increment(now); });
      });
  double work = 0;
  for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) work += w.block_stats[b].external_work;
  w.stages.add(std::move(stats), work, factors.kept);
}

template <class R>
double GridUpdate<R>::end_stages(const World<R>& world, GridStats& found) {
  Work& w = *work_;
  found.fields.work = w.field_work(world);
  return w.stages.end(found);
}

template <class R>
GridStats GridUpdate<R>::Work::total(const World<R>& world) {
  GridStats total;
  total.kinetic = images.add_impulses(total.walls);
  total.colliders.resize(world.colliders.size());
  for (const GridStats& some : sums) {
    total.max_speed = std::max(total.max_speed, some.max_speed);
    total.mass += some.mass;
    total.kinetic += some.kinetic;
    total.arrived += some.arrived;
    total.moment += some.moment;
    total.damping += some.damping;
    total.fields += some.fields;
    total.finite = total.finite && some.finite;
    for (std::size_t side = 0; side < 6; ++side) total.walls[side] += some.walls[side];
    for (std::size_t c = 0; c < total.colliders.size(); ++c) total.colliders[c] += some.colliders[c];
  }
  return total;
}

template class GridUpdate<float>;
template class GridUpdate<double>;

}  // namespace dreampm
