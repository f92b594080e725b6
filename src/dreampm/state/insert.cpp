#include <algorithm>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/column_room.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/held_cells.h"
#include "dreampm/state/regroup.h"

namespace dreampm {
namespace {

constexpr std::size_t seeds_at_once = 1 << 10;

/// Makes those blocks part of the world's, in their order; old and new particles are then sorted by
/// the same rule.
template <class R>
void add_blocks(World<R>& world, std::vector<Vec3i> more) {
  BlockList blocks;
  more.insert(more.end(), world.particle_blocks.begin(), world.particle_blocks.end());
  blocks.assign(std::move(more));
  for (auto& set : world.sets) {
    std::vector<std::uint32_t> start(blocks.size() + 1, 0);
    for (std::size_t b = 0, old = 0; b < blocks.size(); ++b) {
      start[b + 1] = start[b];
      if (old == world.particle_blocks.size() || !(world.particle_blocks[old] == blocks[b])) continue;
      if (!set.block_start.empty()) start[b + 1] += set.block_start[old + 1] - set.block_start[old];
      ++old;
    }
    set.block_start = std::move(start);
  }
  world.particle_blocks = blocks.all();
}

/// The blocks of new particles, by their number in the world's list, which has all of them then.
template <class R>
std::vector<std::uint32_t> find_blocks(World<R>& world, const std::vector<typename World<R>::BlockPosition>& places) {
  BlockList blocks;
  std::vector<std::uint32_t> found(places.size());
  const auto find_all = [&] {
    std::vector<Vec3i> all = world.particle_blocks;
    blocks.exchange(all);
    parallel_for(places.size(), seeds_at_once, [&](std::size_t i) {
      found[i] = static_cast<std::uint32_t>(blocks.find(places[i].block));  // none is the largest
    });
  };
  find_all();
  std::vector<Vec3i> missing;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (found[i] == static_cast<std::uint32_t>(BlockList::none) &&
        (missing.empty() || !(missing.back() == places[i].block)))
      missing.push_back(places[i].block);
  const bool fits = std::all_of(world.sets.begin(), world.sets.end(), [&](const auto& s) {
    return s.block_start.size() == world.particle_blocks.size() + 1;
  });
  if (!missing.empty() || !fits) add_blocks(world, missing), find_all();
  return found;
}

/// Particles that a set may come to hold: with the pools of its emitters, all memory of its columns
/// is taken when the first of them comes in.
template <class R>
std::size_t room_of(const World<R>& world, std::size_t index, std::size_t size) {
  std::uint64_t room = size;
  for (const Emitter& e : world.emitters)
    if (e.set == index) room = e.recycle ? std::max(room, e.pool) : room + (e.pool - std::min(e.pool, e.born));
  return room;
}

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
  auto& set = world.sets.at(index);
  for (const ParticleSeed& n : seeds)
    if (!is_finite(n.position)) fail_run("a particle of material {} has no finite position", set.name);

  std::vector<typename World<R>::BlockPosition> places(seeds.size());
  parallel_for(seeds.size(), seeds_at_once, [&](std::size_t i) { places[i] = world.locate(seeds[i].position); });
  const std::vector<std::uint32_t> block = find_blocks(world, places);

  // The order within a block: particles that were there first, then new ones in their order.
  const std::size_t blocks = world.particle_blocks.size();
  std::vector<std::uint32_t> start(blocks + 1, 0), next(blocks), at(seeds.size());
  for (const std::uint32_t b : block) ++start[b + 1];
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint32_t there = set.block_start[b + 1] - set.block_start[b];
    next[b] = start[b] + there;
    start[b + 1] += next[b];
  }
  for (std::size_t i = 0; i < seeds.size(); ++i) at[i] = next[block[i]]++;

  const ColumnRoom opening(set.block_start, start);
  const std::size_t room = room_of(world, index, start.back());
  const auto extend = [&](auto& column, const auto& value) {
    column.reserve(room);
    column.resize(start.back());
    opening.open(std::span(column));
    parallel_for(seeds.size(), seeds_at_once, [&](std::size_t i) { column[at[i]] = value(i); });
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
  set.block_start = std::move(start);
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
