#include "dreampm/base/error.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/regroup.h"

namespace dreampm {
namespace {

/// The old blocks and those of the seeds.
template <class R>
BlockList all_blocks(const World<R>& world, std::span<const ParticleSeed> seeds) {
  std::vector<Vec3i> all = world.particle_blocks;
  for (const ParticleSeed& n : seeds) {
    const Vec3i block = world.locate(n.position).block;
    if (all.empty() || !(all.back() == block)) all.push_back(block);
  }
  BlockList blocks;
  blocks.assign(std::move(all));
  return blocks;
}

/// Puts the values of new particles, value(number of the seed), into a column: place i takes what
/// `from` names, first the old particles, then the new ones. `from` keeps the order of the old, so
/// that none moves to a lower place. Takes memory for `room` particles.
template <class Vector, class Value>
void extend(Vector& column, const std::vector<std::uint32_t>& from, std::size_t old_size, std::size_t room,
            const Value& value) {
  column.reserve(room);
  column.resize(from.size());
  for (std::size_t i = from.size(); i-- > 0;)
    column[i] = from[i] < old_size ? column[from[i]] : value(from[i] - old_size);
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

/// As GridTopology takes them.
template <class R>
std::vector<std::uint64_t> cells_of(const World<R>& world) {
  if (world.drift > 0) return std::vector<std::uint64_t>(world.particle_blocks.size(), ~std::uint64_t{0});
  std::vector<std::uint64_t> cells(world.particle_blocks.size());
  const auto cell = [](R u) { return std::clamp(static_cast<int>(u), 0, block_width - 1); };
  for (const ParticleSet<R>& set : world.sets)
    for (std::size_t b = 0; b < cells.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p)
        cells[b] |= std::uint64_t{1} << node_index(cell(set.u[0][p]), cell(set.u[1][p]), cell(set.u[2][p]));
  return cells;
}

}  // namespace

template <class R>
void insert(World<R>& world, std::size_t index, std::span<const ParticleSeed> seeds) {
  auto& set = world.sets.at(index);
  for (const ParticleSeed& n : seeds)
    if (!is_finite(n.position)) fail_run("a particle of material {} has no finite position", set.name);

  // New blocks join the list first, so that old and new particles are sorted by the same rule.
  const BlockList blocks = all_blocks(world, seeds);
  const auto place_of = [&](const Vec3i& b) { return static_cast<std::size_t>(blocks.find(b)); };
  for (auto& s : world.sets) {
    std::vector<std::uint32_t> start(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < world.particle_blocks.size() && !s.block_start.empty(); ++b)
      start[place_of(world.particle_blocks[b]) + 1] = s.block_start[b + 1] - s.block_start[b];
    for (std::size_t b = 0; b < blocks.size(); ++b) start[b + 1] += start[b];
    s.block_start = std::move(start);
  }
  world.particle_blocks = blocks.all();

  // Of each block, first those that were there, then the new ones in their order.
  const std::size_t old_size = set.size();
  std::vector<std::uint32_t> start(blocks.size() + 1, 0);
  for (const ParticleSeed& n : seeds) ++start[place_of(world.locate(n.position).block) + 1];
  for (std::size_t b = 0; b < blocks.size(); ++b)
    start[b + 1] += start[b] + set.block_start[b + 1] - set.block_start[b];
  std::vector<std::uint32_t> from(start.back()), next(start.begin(), start.end() - 1);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) from[next[b]++] = p;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    from[next[place_of(world.locate(seeds[i].position).block)]++] = static_cast<std::uint32_t>(old_size + i);

  const std::size_t room = room_of(world, index, from.size());
  extend(set.id, from, old_size, room, [&](std::size_t i) { return seeds[i].id; });
  for (int a = 0; a < 3; ++a)
    extend(set.u[a], from, old_size, room, [&](std::size_t i) { return world.locate(seeds[i].position).at[a]; });
  if (set.has_own())
    for (int a = 0; a < 3; ++a)
      extend(set.own[a], from, old_size, room, [&](std::size_t i) { return static_cast<R>(seeds[i].velocity[a]); });
  if (set.carries_motion)
    for (int c = 0; c < 9; ++c)
      extend(set.gradient[static_cast<std::size_t>(c)], from, old_size, room,
             [&](std::size_t i) { return static_cast<R>(seeds[i].gradient(c / 3, c % 3)); });
  Materials::with(set.material, [&]<class M>() {
    set.state.resize(state_columns<M>);
    for (int c = 0; c < state_columns<M>; ++c)
      extend(set.state[c], from, old_size, room,
             [&](std::size_t) { return static_cast<R>(M::template State<R>::rest[c]); });
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
  compact(set.id);
  for (auto& axis : set.u) compact(axis);
  for (auto& column : set.state) compact(column);
  for (auto& axis : set.own) compact(axis);
  for (auto& column : set.gradient) compact(column);
  return keep.size() - set.size();
}

template std::size_t erase(World<float>&, std::size_t, const std::vector<bool>&);
template std::size_t erase(World<double>&, std::size_t, const std::vector<bool>&);
template void insert(World<float>&, std::size_t, std::span<const ParticleSeed>);
template void insert(World<double>&, std::size_t, std::span<const ParticleSeed>);

}  // namespace dreampm
