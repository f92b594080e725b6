#include "dreampm/state/regroup.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

/// Where a particle lies after regrouping: the block it moved to, as one of the 27 around its old one.
constexpr int here = 13;
template <class R>
int neighbour_of(const Vec3<R>& u) {
  const auto side = [](R a) { return a < R(0) ? 0 : a < R(block_width) ? 1 : 2; };
  return (side(u.x) * 3 + side(u.y)) * 3 + side(u.z);
}
constexpr Vec3i offset_of(int neighbour) { return {neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1}; }

template <class T>
void permute(std::vector<T>& column, const std::vector<std::uint32_t>& from) {
  std::vector<T> next(from.size());
  parallel_ranges(from.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) next[i] = column[from[i]];
  });
  column.swap(next);
}

/// Orders the particles of one block by their cell, those of a cell as they were: neighbours in memory then share
/// nodes.
template <class R>
void sort_by_cell(const ParticleSet<R>& set, std::span<std::uint32_t> particles) {
  std::array<std::uint32_t, block_nodes + 1> start{};
  std::vector<std::uint8_t> cell(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    int index = 0;
    for (const auto& axis : set.u)
      index = index * block_width + std::clamp(static_cast<int>(axis[particles[i]]), 0, block_width - 1);
    cell[i] = static_cast<std::uint8_t>(index);
    ++start[static_cast<std::size_t>(index) + 1];
  }
  for (std::size_t c = 0; c < block_nodes; ++c) start[c + 1] += start[c];
  const std::vector<std::uint32_t> before(particles.begin(), particles.end());
  for (std::size_t i = 0; i < before.size(); ++i) particles[start[cell[i]]++] = before[i];
}

/// True if every point of the block is more than a box length outside an open wall.
template <class R>
bool beyond(const World<R>& world, const Vec3i& block) {
  const Vec3i size = world.high - world.low;
  for (int a = 0; a < 3; ++a) {
    if (world.periodic[static_cast<std::size_t>(a)]) continue;
    const std::int32_t first = block[a] * block_width;
    if (first + block_width < world.low[a] - size[a] || first > world.high[a] + size[a]) return true;
  }
  return false;
}

/// Grid blocks around all particle blocks: stencils reach nodes -1 .. 6 of a block until the next sort.
template <class R>
void lay_grid(World<R>& world) {
  std::vector<Vec3i> wanted;
  wanted.reserve(world.particle_blocks.size() * 27);
  for (const Vec3i& b : world.particle_blocks)
    for (int n = 0; n < 27; ++n) wanted.push_back(world.wrapped(b + offset_of(n)));
  Carried<R> next;
  next.blocks.assign(std::move(wanted));
  next.nodes.resize(next.blocks.size() * block_nodes);
  if (world.needs_solid_field()) next.solids.resize(next.nodes.size());
  if (world.needs_liquid_channel()) next.liquid.resize(next.nodes.size());
  for (std::size_t f = 0; f < 2; ++f)
    if (world.keeps_velocities(f)) next.before[f].resize(next.nodes.size());
  for (std::size_t b = 0; b < next.blocks.size(); ++b) {
    const std::int32_t old = world.grid.blocks.find(next.blocks[b]);
    if (old == BlockList::none) continue;
    const auto copy = [&](const auto& source, auto& target) {
      if (!source.empty() && !target.empty())
        std::copy_n(source.begin() + std::ptrdiff_t(old) * block_nodes, block_nodes,
                    target.begin() + std::ptrdiff_t(b) * block_nodes);
    };
    copy(world.grid.nodes, next.nodes);
    copy(world.grid.solids, next.solids);
    copy(world.grid.liquid, next.liquid);
    for (std::size_t f = 0; f < 2; ++f) copy(world.grid.before[f], next.before[f]);
  }
  world.grid = std::move(next);
}

}  // namespace

template <class R>
void regroup(World<R>& world) {
  const std::vector<Vec3i> old_blocks = std::move(world.particle_blocks);
  // Which of the 27 neighbours each particle moved to.
  std::vector<std::vector<std::uint8_t>> moved(world.sets.size());
  std::vector<std::uint32_t> seen(old_blocks.size(), 0);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    auto& set = world.sets[s];
    if (set.block_start.size() != old_blocks.size() + 1) set.block_start.assign(old_blocks.size() + 1, 0);
    moved[s].resize(set.size());
    parallel_for(old_blocks.size(), 16, [&](std::size_t b) {
      for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        const int n = neighbour_of(Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]});
        moved[s][p] = static_cast<std::uint8_t>(n);
        seen[b] |= 1u << n;
      }
    });
  }
  BlockList blocks;
  {
    std::vector<Vec3i> used;
    for (std::size_t b = 0; b < old_blocks.size(); ++b)
      for (int n = 0; n < 27; ++n)
        if (seen[b] >> n & 1) used.push_back(world.wrapped(old_blocks[b] + offset_of(n)));
    blocks.assign(std::move(used));
  }
  std::vector<Vec3i> kept;
  std::vector<std::int32_t> new_index(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const bool gone = beyond(world, blocks[b]);
    new_index[b] = gone ? BlockList::none : static_cast<std::int32_t>(kept.size());
    if (!gone) kept.push_back(blocks[b]);
  }
  world.particle_blocks = kept;

  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    auto& set = world.sets[s];
    std::vector<std::uint32_t> start(kept.size() + 1, 0);
    std::vector<std::int32_t> target(set.size());
    for (std::size_t b = 0; b < old_blocks.size(); ++b) {
      std::array<std::int32_t, 27> to;
      for (int n = 0; n < 27; ++n) {
        to[n] = BlockList::none;
        if (seen[b] >> n & 1) to[n] = new_index[blocks.find(world.wrapped(old_blocks[b] + offset_of(n)))];
      }
      for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        const int n = moved[s][p];
        target[p] = to[n];
        if (to[n] == BlockList::none) {
          ++world.left;
          continue;
        }
        ++start[to[n] + 1];
        if (n == here) continue;
        const Vec3i offset = offset_of(n);
        for (int a = 0; a < 3; ++a) set.u[a][p] -= static_cast<R>(offset[a] * block_width);
      }
    }
    for (std::size_t b = 0; b < kept.size(); ++b) start[b + 1] += start[b];
    std::vector<std::uint32_t> from(start.back()), next(start.begin(), start.end() - 1);
    for (std::size_t p = 0; p < set.size(); ++p)
      if (target[p] != BlockList::none) from[next[target[p]]++] = static_cast<std::uint32_t>(p);
    parallel_for(kept.size(), 16,
                 [&](std::size_t b) { sort_by_cell(set, {from.data() + start[b], start[b + 1] - start[b]}); });
    permute(set.id, from);
    for (auto& axis : set.u) permute(axis, from);
    for (auto& column : set.state) permute(column, from);
    if (set.transfer.keeps_velocity())
      for (auto& axis : set.own) permute(axis, from);
    set.block_start = std::move(start);
  }
  world.drift = 0;
  lay_grid(world);
}

template <class R>
void insert(World<R>& world, std::size_t index, std::span<const Newborn> newborns) {
  auto& set = world.sets.at(index);
  // New blocks join the list first, so that old and new particles are sorted by the same rule.
  BlockList blocks;
  std::vector<Vec3i> all = world.particle_blocks;
  std::vector<Vec3i> home(newborns.size());
  std::vector<Vec3<R>> at(newborns.size());
  for (std::size_t i = 0; i < newborns.size(); ++i) {
    const Vec3d cells = (newborns[i].position - world.origin) * (1 / world.dx);
    if (!is_finite(cells)) fail_run("a particle of material {} has no finite position", set.name);
    for (int a = 0; a < 3; ++a) {
      const double u = cells[a] - 0.5;
      home[i][a] = (world.low[a] + static_cast<std::int32_t>(std::floor(u))) >> 2;
      at[i][a] = static_cast<R>(u - (home[i][a] * block_width - world.low[a]));
    }
    home[i] = world.wrapped(home[i]);
    all.push_back(home[i]);
  }
  blocks.assign(std::move(all));
  for (auto& s : world.sets) {
    std::vector<std::uint32_t> start(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < world.particle_blocks.size() && !s.block_start.empty(); ++b)
      start[blocks.find(world.particle_blocks[b]) + 1] = s.block_start[b + 1] - s.block_start[b];
    for (std::size_t b = 0; b < blocks.size(); ++b) start[b + 1] += start[b];
    s.block_start = std::move(start);
  }
  world.particle_blocks = blocks.all();

  const std::size_t old_size = set.size();
  std::vector<std::vector<std::uint32_t>> arrivals(blocks.size());
  for (std::size_t i = 0; i < newborns.size(); ++i)
    arrivals[blocks.find(home[i])].push_back(static_cast<std::uint32_t>(old_size + i));
  for (const Newborn& n : newborns) set.id.push_back(n.id);
  for (int a = 0; a < 3; ++a)
    for (const auto& p : at) set.u[a].push_back(p[a]);
  if (set.transfer.keeps_velocity())
    for (int a = 0; a < 3; ++a)
      for (const Newborn& n : newborns) set.own[a].push_back(static_cast<R>(n.velocity[a]));
  Materials::with(set.material, [&]<class M>() {
    set.state.resize(state_columns<M>);
    for (int c = 0; c < state_columns<M>; ++c)
      set.state[c].resize(set.id.size(), static_cast<R>(M::template State<R>::rest[c]));
  });
  std::vector<std::uint32_t> from;
  from.reserve(set.size());
  std::vector<std::uint32_t> start(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) from.push_back(p);
    from.insert(from.end(), arrivals[b].begin(), arrivals[b].end());
    start[b + 1] = static_cast<std::uint32_t>(from.size());
  }
  permute(set.id, from);
  for (auto& axis : set.u) permute(axis, from);
  for (auto& column : set.state) permute(column, from);
  if (set.transfer.keeps_velocity())
    for (auto& axis : set.own) permute(axis, from);
  set.block_start = std::move(start);
  lay_grid(world);
}

template void regroup(World<float>&);
template void regroup(World<double>&);
template void insert(World<float>&, std::size_t, std::span<const Newborn>);
template void insert(World<double>&, std::size_t, std::span<const Newborn>);

}  // namespace dreampm
