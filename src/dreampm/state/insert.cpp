#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/lay_grid.h"
#include "dreampm/state/regroup.h"

namespace dreampm {
namespace {

template <class T>
void permute(std::vector<T>& column, const std::vector<std::uint32_t>& from) {
  std::vector<T> next(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) next[i] = column[from[i]];
  column.swap(next);
}

}  // namespace

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
    std::vector<std::uint32_t> held(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < world.particle_blocks.size() && !s.block_start.empty(); ++b)
      held[static_cast<std::size_t>(blocks.find(world.particle_blocks[b])) + 1] =
          s.block_start[b + 1] - s.block_start[b];
    for (std::size_t b = 0; b < blocks.size(); ++b) held[b + 1] += held[b];
    s.block_start = std::move(held);
  }
  world.particle_blocks = blocks.all();

  const std::size_t old_size = set.size();
  // Of each block, first those that were there, then the new ones in their order.
  std::vector<std::uint32_t> start(blocks.size() + 1, 0);
  for (const Vec3i& b : home) ++start[static_cast<std::size_t>(blocks.find(b)) + 1];
  for (std::size_t b = 0; b < blocks.size(); ++b)
    start[b + 1] += start[b] + set.block_start[b + 1] - set.block_start[b];
  std::vector<std::uint32_t> from(start.back()), next(start.begin(), start.end() - 1);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) from[next[b]++] = p;
  for (std::size_t i = 0; i < newborns.size(); ++i)
    from[next[static_cast<std::size_t>(blocks.find(home[i]))]++] = static_cast<std::uint32_t>(old_size + i);

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
  permute(set.id, from);
  for (auto& axis : set.u) permute(axis, from);
  for (auto& column : set.state) permute(column, from);
  if (set.transfer.keeps_velocity())
    for (auto& axis : set.own) permute(axis, from);
  set.block_start = std::move(start);
  Carried<R> spare;
  LayGrid<R>()(world, spare);
}

template void insert(World<float>&, std::size_t, std::span<const Newborn>);
template void insert(World<double>&, std::size_t, std::span<const Newborn>);

}  // namespace dreampm
