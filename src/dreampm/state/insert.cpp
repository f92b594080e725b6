#include <algorithm>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/column_room.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/held_cells.h"
#include "dreampm/state/insert_plan.h"
#include "dreampm/state/regroup.h"

namespace dreampm {
namespace {

constexpr std::size_t seeds_at_once = 1 << 10;

/// Returns the cells with particles, in the form that GridTopology takes.
template <class R>
std::vector<std::uint64_t> cells_of(const World<R>& world) {
  std::vector<std::uint64_t> cells(world.particle_blocks.size(), world.drift > 0 ? ~std::uint64_t{0} : 0);
  if (world.drift > 0) return cells;
  parallel_for(cells.size(), 16, [&](std::size_t b) { cells[b] = held_cells(world, b); });
  return cells;
}

}  // namespace

template <class R>
void insert(World<R>& world, std::size_t index, std::span<const ParticleSeed> seeds) {
  InsertPlan<R> plan(world, index, seeds);
  plan.exchange(world);
  auto& set = world.sets[index];
  const auto& places = plan.places();
  const auto& number = plan.numbers();
  const std::size_t size = plan.start().back();
  const ColumnRoom opening(set.block_start, plan.start());
  const auto extend = [&](auto& column, const auto& value) {
    column.reserve(plan.room());
    column.resize(size);
    opening.open(std::span(column));
    parallel_for(seeds.size(), seeds_at_once, [&](std::size_t i) { column[number[i]] = value(i); });
  };
  extend(set.id, [&](std::size_t i) { return seeds[i].id; });
  for (int a = 0; a < 3; ++a) extend(set.u[a], [&](std::size_t i) { return places[i].at[a]; });
  if (set.has_own_velocity())
    for (int a = 0; a < 3; ++a)
      extend(set.own_velocity[a], [&](std::size_t i) { return static_cast<R>(seeds[i].velocity[a]); });
  if (set.carries_motion)
    for (int c = 0; c < 9; ++c)
      extend(set.gradient[static_cast<std::size_t>(c)],
             [&](std::size_t i) { return static_cast<R>(seeds[i].gradient(c / 3, c % 3)); });
  Materials::with(set.material, [&]<class M>() {
    set.state.resize(state_columns<M>);
    for (int c = 0; c < state_columns<M>; ++c)
      extend(set.state[c], [&](std::size_t) { return static_cast<R>(M::template State<R>::rest[c]); });
  });
  set.block_start = std::move(plan.start());
  GridFields<R> spare;
  GridTopology<R>()(world, cells_of(world), spare);
}

template <class R>
std::size_t erase(World<R>& world, std::size_t index, const std::vector<bool>& keep) {
  ParticleSet<R>& set = world.sets.at(index);
  if (keep.size() != set.size()) fail_run("erase: {} flags for {} particles", keep.size(), set.size());
  const auto compact = [&](auto& column) {
    if (column.empty()) return;
    std::size_t to = 0;
    for (std::size_t p = 0; p < keep.size(); ++p)
      if (keep[p]) column[to++] = column[p];
    column.resize(to);
  };
  std::vector<std::uint32_t> start(set.block_start.size(), 0);
  for (std::size_t b = 0; b + 1 < start.size(); ++b) {
    start[b + 1] = start[b];
    for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) start[b + 1] += keep[p];
  }
  set.block_start = std::move(start);
  std::vector<LargeVector<R>*> columns;
  for (auto& axis : set.u) columns.push_back(&axis);
  for (auto& column : set.state) columns.push_back(&column);
  for (auto& axis : set.own_velocity) columns.push_back(&axis);
  for (auto& column : set.gradient) columns.push_back(&column);
  parallel_for(columns.size() + 1, 1, [&](std::size_t c) {
    if (c < columns.size())
      compact(*columns[c]);
    else
      compact(set.id);
  });
  return keep.size() - set.size();
}

template std::size_t erase(World<float>&, std::size_t, const std::vector<bool>&);
template std::size_t erase(World<double>&, std::size_t, const std::vector<bool>&);
template void insert(World<float>&, std::size_t, std::span<const ParticleSeed>);
template void insert(World<double>&, std::size_t, std::span<const ParticleSeed>);

}  // namespace dreampm
