#include "dreampm/state/regroup.h"

#include <algorithm>
#include <array>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/take_out.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

/// A particle on its way, in 32 bits: its number within its old block, then the cell that it comes
/// to in the new one.
constexpr int cell_bits = 6;
constexpr std::uint32_t cell_mask = (1u << cell_bits) - 1;
static_assert(1 << cell_bits == block_nodes);

/// -1, 0 or 1: to which side of its block a position has moved along an axis.
template <class R>
int side_of(R u) {
  return 1 - (u < R(block_width)) - (u < R(0));
}
/// The same position seen from the block on that side.
template <class R>
R seen_there(R u) {
  return u - static_cast<R>(block_width * side_of(u));
}
/// The cell that it lies in there.
template <class R>
int cell_of(R u) {
  const int towards_zero = static_cast<int>(u);
  return (towards_zero - (u < static_cast<R>(towards_zero))) & (block_width - 1);
}

/// Returns the place of a cell in the order of a block: row after row along z, each beside the one
/// before, so that those of two rows that share a vector of lanes share nodes as well.
constexpr int turn_of(int i, int j, int k) { return node_index(i, j ^ ((i & 1) * (block_width - 1)), k); }
/// The cell that comes at a turn, as a bit of node_index().
constexpr std::array<std::uint64_t, block_nodes> cell_at = [] {
  std::array<std::uint64_t, block_nodes> cells{};
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i at = node_offset(n);
    cells[static_cast<std::size_t>(turn_of(at.x, at.y, at.z))] = std::uint64_t{1} << n;
  }
  return cells;
}();

/// The destination of particles that sinks take, in place of a neighbor.
constexpr std::uint8_t nowhere = 27;

/// The first neighbor that is the same block, for each of the 27 and `nowhere`: on periodic axes of
/// one or two blocks some are.
using Alike = std::array<std::uint8_t, 28>;
template <class R>
Alike first_alike(const World<R>& world) {
  Alike first{};
  first[nowhere] = nowhere;
  for (int n = 0; n < 27; ++n)
    for (int m = n; m >= 0; --m)
      if (world.wrapped(neighbor_offset(m)) == world.wrapped(neighbor_offset(n)))
        first[static_cast<std::size_t>(n)] = static_cast<std::uint8_t>(m);
  return first;
}

/// True if every point of the block is more than a box length outside an open wall.
template <class R>
bool beyond(const World<R>& world, const Vec3i& block) {
  const Vec3i size = world.high - world.low;
  for (int a = 0; a < 3; ++a) {
    if (world.periodic[static_cast<std::size_t>(a)]) continue;
    const std::int32_t first = first_stencil(block)[a];
    if (first + block_width < world.low[a] - size[a] || first > world.high[a] + size[a]) return true;
  }
  return false;
}

/// The particles that come to a block: those that leave one of the old blocks for one of its
/// neighbors, each `old block * 32 + neighbor`, in the order of the old blocks. (More blocks than
/// fit would need 128 GiB.)
struct Sources {
  std::uint32_t count = 0;
  std::array<std::uint32_t, 27> of;
};

/// Working memory of a sort for one set.
template <class R>
struct SetRoom {
  /// For each old block and neighbor n, the place in `order` where the particles begin that move
  /// there; [27] is the end of all that stay in the world.
  std::vector<std::array<std::uint32_t, 28>> runs;
  std::vector<std::uint32_t> order;   ///< the particles of each old block, by the neighbor that they move to
  std::vector<std::uint32_t> from;    ///< old place of each particle
  std::vector<std::uint32_t> before;  ///< place of each particle before the first of two sorts
  std::vector<std::uint32_t> start;   ///< block_start of the new blocks
  LargeVector<R> column;

  void prepare(ParticleSet<R>& set, std::size_t blocks) {
    if (set.block_start.size() != blocks + 1) set.block_start.assign(blocks + 1, 0);
    resize_for_overwrite(runs, blocks);
    resize_for_overwrite(order, set.size());
    resize_for_overwrite(from, set.size());
  }
};

/// Calls body(quarter, i) for every i below `count`, in order within each quarter, the quarters
/// taking turns: a counter that the last body wrote is then seldom read at once, which would have
/// to wait.
template <class Body>
void in_quarters(std::uint32_t count, const Body& body) {
  const std::uint32_t quarter = count / 4;
  for (std::uint32_t i = 0; i < quarter; ++i) {
    body(0, i);
    body(1, i + quarter);
    body(2, i + 2 * quarter);
    body(3, i + 3 * quarter);
  }
  for (std::uint32_t i = 4 * quarter; i < count; ++i) body(3, i);
}

/// Orders the particles of an old block by the neighbor that they move to, stably; those `taken`
/// [numbers in the set, rising] move nowhere. Returns the neighbors that any moves to, as
/// HaloMask::around.
template <class R>
std::uint64_t part(const ParticleSet<R>& set, SetRoom<R>& room, std::size_t b, const Alike& alike,
                   const std::vector<std::uint32_t>& taken) {
  const std::uint32_t begin = set.block_start[b], count = set.block_start[b + 1] - begin;
  if (count >= 1u << (32 - cell_bits))
    fail_run("{} particles of material {} lie in one block of 4 x 4 x 4 cells", count, set.name);
  // The old places are not known yet: their memory holds neighbor and cell.
  std::uint32_t* key = room.from.data() + begin;
  const R *x = set.u[0].data() + begin, *y = set.u[1].data() + begin, *z = set.u[2].data() + begin;
  for (std::uint32_t i = 0; i < count; ++i) {
    const int neighbor = ((side_of(x[i]) + 1) * 3 + side_of(y[i]) + 1) * 3 + side_of(z[i]) + 1;
    key[i] = static_cast<std::uint32_t>(neighbor << cell_bits | turn_of(cell_of(x[i]), cell_of(y[i]), cell_of(z[i])));
  }
  for (auto p = std::lower_bound(taken.begin(), taken.end(), begin); p != taken.end() && *p < begin + count; ++p)
    key[*p - begin] = std::uint32_t{nowhere} << cell_bits;
  std::array<std::array<std::uint32_t, 28>, 4> next{};
  in_quarters(count, [&](std::size_t q, std::uint32_t i) { ++next[q][alike[key[i] >> cell_bits]]; });
  auto& runs = room.runs[b];
  std::uint64_t seen = 0;
  std::uint32_t at = begin;
  for (std::size_t n = 0; n < 28; ++n) {
    runs[n] = at;
    for (auto& quarter : next) at += std::exchange(quarter[n], at);
    if (at > runs[n] && n != nowhere) seen |= halo_bit(neighbor_offset(static_cast<int>(n)));
  }
  in_quarters(count, [&](std::size_t q, std::uint32_t i) {
    room.order[next[q][alike[key[i] >> cell_bits]]++] = i << cell_bits | (key[i] & cell_mask);
  });
  return seen;
}

/// Orders the particles that come to a block by their cell, those of a cell as they were:
/// neighbors in memory then share nodes. Returns the cells that have any, as GridTopology takes
/// them.
template <class R>
std::uint64_t sort_by_cell(const ParticleSet<R>& set, SetRoom<R>& room, const Sources& sources, std::uint32_t start) {
  std::array<std::uint32_t, block_nodes + 1> next{};
  next[0] = start;
  const auto each_run = [&](const auto& body) {
    for (std::uint32_t s = 0; s < sources.count; ++s) {
      const std::uint32_t old = sources.of[s] / 32, neighbor = sources.of[s] % 32;
      body(old, room.runs[old][neighbor], room.runs[old][neighbor + 1]);
    }
  };
  each_run([&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) ++next[(room.order[i] & cell_mask) + 1];
  });
  std::uint64_t cells = 0;
  for (std::size_t c = 0; c < block_nodes; ++c) {
    if (next[c + 1] > 0) cells |= cell_at[c];
    next[c + 1] += next[c];
  }
  each_run([&](std::uint32_t old, std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t first = set.block_start[old];
    for (std::uint32_t i = begin; i < end; ++i)
      room.from[next[room.order[i] & cell_mask]++] = first + (room.order[i] >> cell_bits);
  });
  return cells;
}

/// column[i] = column[from[i]], with the memory of `spare`. `change`(begin, end) is called for
/// pieces as they come.
template <class Vector, class Change>
void permute(Vector& column, Vector& spare, const std::vector<std::uint32_t>& from, std::size_t size,
             const Change& change) {
  // A column with room for what comes in keeps it.
  if (spare.capacity() < column.capacity()) Vector().swap(spare), spare.reserve(column.capacity());
  resize_for_overwrite(spare, size);
  parallel_ranges(size, 1 << 14, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t piece = 1024;
    const auto* source = column.data();
    auto* target = spare.data();
    for (; begin < end; begin += std::min(piece, end - begin)) {
      const std::size_t stop = std::min(begin + piece, end);
#pragma GCC unroll 8
      for (std::size_t i = begin; i < stop; ++i) target[i] = source[from[i]];
      change(target + begin, target + stop);
    }
  });
  column.swap(spare);
}

}  // namespace

template <class R>
struct Regroup<R>::Scratch {
  BlockList old;
  std::vector<HaloMask> reach;
  HaloUnion spread;
  std::vector<Sources> sources;      ///< for every new block
  std::vector<std::uint64_t> cells;  ///< cells with particles of every new block
  std::vector<SetRoom<R>> sets;
  std::vector<std::vector<std::uint32_t>> taken;  ///< by set, particles that sinks take: they move nowhere
  GridTopology<R> topology;

  void find_moves(World<R>& world);
  void find_blocks(World<R>& world);
  void find_places(World<R>& world);
  void move_places(ParticleSet<R>& set, SetRoom<R>& room);
  void move_all(ParticleSet<R>& set, SetRoom<R>& room, bool twice);
};

/// Every old block's particles by the neighbor that they move to.
template <class R>
void Regroup<R>::Scratch::find_moves(World<R>& world) {
  old.exchange(world.particle_blocks);
  sets.resize(world.sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) sets[s].prepare(world.sets[s], old.size());
  resize_for_overwrite(reach, old.size());
  const auto alike = first_alike(world);
  parallel_for(old.size(), 16, [&](std::size_t b) {
    reach[b] = {old[b], 0};
    for (std::size_t s = 0; s < sets.size(); ++s) reach[b].around |= part(world.sets[s], sets[s], b, alike, taken[s]);
  });
}

/// The new blocks, and where their particles come from.
template <class R>
void Regroup<R>::Scratch::find_blocks(World<R>& world) {
  std::vector<Vec3i>& blocks = spread(world, reach);
  std::erase_if(blocks, [&](const Vec3i& b) { return beyond(world, b); });
  world.particle_blocks.swap(blocks);

  resize_for_overwrite(sources, world.particle_blocks.size());
  for (std::size_t s = 0; s < sets.size(); ++s) resize_for_overwrite(sets[s].start, world.particle_blocks.size() + 1);
  const auto alike = first_alike(world);
  parallel_for(sources.size(), 16, [&](std::size_t b) {
    const Neighbors around = neighbors_in(old, world, world.particle_blocks[b]);
    Sources& from = sources[b];
    from.count = 0;
    for (SetRoom<R>& room : sets) room.start[b + 1] = 0;
    for (std::size_t n = 0; n < 27; ++n) {
      // They come from there by going the opposite way.
      const std::size_t way = 26 - n;
      if (around[n] == BlockList::none || alike[way] != way) continue;
      const auto block = static_cast<std::uint32_t>(around[n]);
      std::uint32_t all = 0;
      for (SetRoom<R>& room : sets) {
        const std::uint32_t arrivals = room.runs[block][way + 1] - room.runs[block][way];
        room.start[b + 1] += arrivals;
        all |= arrivals;
      }
      if (all > 0) from.of[from.count++] = block * 32 + static_cast<std::uint32_t>(way);
    }
    std::sort(from.of.begin(), from.of.begin() + from.count);
  });
}

/// Finds the old place of every particle.
template <class R>
void Regroup<R>::Scratch::find_places(World<R>& world) {
  for (std::size_t s = 0; s < sets.size(); ++s) {
    auto& start = sets[s].start;
    start[0] = 0;
    for (std::size_t b = 0; b + 1 < start.size(); ++b) start[b + 1] += start[b];
    world.left += world.sets[s].block_start.back() - start.back();
  }
  resize_for_overwrite(cells, sources.size());
  parallel_for(sources.size(), 16, [&](std::size_t b) {
    cells[b] = 0;
    for (std::size_t s = 0; s < sets.size(); ++s)
      if (sets[s].start[b] < sets[s].start[b + 1])
        cells[b] |= sort_by_cell(world.sets[s], sets[s], sources[b], sets[s].start[b]);
  });
}

/// Positions alone, from block to block.
template <class R>
void Regroup<R>::Scratch::move_places(ParticleSet<R>& set, SetRoom<R>& room) {
  const auto seen_there_all = [](R* u, const R* end) {
    for (; u < end; ++u) *u = seen_there(*u);
  };
  for (auto& axis : set.u) permute(axis, room.column, room.from, room.start.back(), seen_there_all);
  set.block_start.swap(room.start);
}

/// `twice`: positions alone have been moved before.
template <class R>
void Regroup<R>::Scratch::move_all(ParticleSet<R>& set, SetRoom<R>& room, bool twice) {
  const std::size_t size = room.start.back();
  move_places(set, room);
  if (twice) parallel_for(size, 1 << 14, [&](std::size_t i) { room.from[i] = room.before[room.from[i]]; });
  const auto as_it_is = [](const auto*, const auto*) {};
  visit_fields(set, [&]<class F>(const F& field, auto& member) {
    if constexpr (F::use.carried) {
      if (field.name == "u" || !field.needed(set)) return;
      visit_columns(member, [&](auto& column) {
        if constexpr (std::is_same_v<decltype(column), LargeVector<R>&>)
          permute(column, room.column, room.from, size, as_it_is);
        else
          permute(column, room.order, room.from, size, as_it_is);
      });
    }
  });
}

template <class R>
Regroup<R>::Regroup() : scratch_(std::make_unique<Scratch>()) {}
template <class R>
Regroup<R>::~Regroup() = default;

template <class R>
void Regroup<R>::operator()(World<R>& world, GridFields<R>& spare, bool far) {
  Scratch& s = *scratch_;
  // Before the first step the grid still holds momenta, with what would be taken out of the matter.
  s.taken.assign(world.sets.size(), {});
  if (world.step > 0 && !world.sinks.empty()) s.taken = take_out(world, far);
  const auto sort = [&] { s.find_moves(world), s.find_blocks(world), s.find_places(world); };
  sort();
  if (far) {
    s.taken.assign(world.sets.size(), {});
    for (std::size_t n = 0; n < world.sets.size(); ++n) {
      s.move_places(world.sets[n], s.sets[n]);
      s.sets[n].before.swap(s.sets[n].from);
    }
    sort();
  }
  for (std::size_t n = 0; n < world.sets.size(); ++n) s.move_all(world.sets[n], s.sets[n], far);
  world.drift = 0;
  s.topology(world, s.cells, spare);
}

template <class R>
void regroup(World<R>& world) {
  GridFields<R> spare;
  Regroup<R>()(world, spare);
}

template class Regroup<float>;
template class Regroup<double>;
template void regroup(World<float>&);
template void regroup(World<double>&);

}  // namespace dreampm
