#include "dreampm/state/regroup.h"

#include <algorithm>
#include <array>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/particle_move.h"
#include "dreampm/state/regroup_plan.h"
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

/// The cell that comes at a turn, as a bit of node_index().
constexpr std::array<std::uint64_t, block_nodes> cell_bit_at = [] {
  std::array<std::uint64_t, block_nodes> cells{};
  for (int turn = 0; turn < block_nodes; ++turn)
    cells[static_cast<std::size_t>(turn)] = std::uint64_t{1} << cell_at(turn);
  return cells;
}();

/// Working memory of a sort for one set.
template <class R>
struct SetRoom {
  std::vector<std::uint32_t> order;   ///< the particles of each old block, by the neighbor that they move to
  std::vector<std::uint32_t> from;    ///< old place of each particle
  std::vector<std::uint32_t> before;  ///< place of each particle before the first of two sorts
  LargeVector<R> column;

  void prepare(const ParticleSet<R>& set) {
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
std::uint64_t part(const ParticleSet<R>& set, SetRoom<R>& room, std::array<std::uint32_t, 28>& runs, std::size_t b,
                   const Alike& alike, const std::vector<std::uint32_t>& taken) {
  const std::uint32_t begin = set.block_start[b], count = set.block_start[b + 1] - begin;
  if (count >= 1u << (32 - cell_bits))
    fail_run("{} particles of material {} lie in one block of 4 x 4 x 4 cells", count, set.name);
  // The old places are not known yet: their memory holds neighbor and cell.
  std::uint32_t* key = room.from.data() + begin;
  const R *x = set.u[0].data() + begin, *y = set.u[1].data() + begin, *z = set.u[2].data() + begin;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3<R> u{x[i], y[i], z[i]};
    key[i] = static_cast<std::uint32_t>(neighbor_of(u) << cell_bits | turn_of(u));
  }
  for (auto p = std::lower_bound(taken.begin(), taken.end(), begin); p != taken.end() && *p < begin + count; ++p)
    key[*p - begin] = std::uint32_t{nowhere} << cell_bits;
  std::array<std::array<std::uint32_t, 28>, 4> next{};
  in_quarters(count, [&](std::size_t q, std::uint32_t i) { ++next[q][alike[key[i] >> cell_bits]]; });
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
std::uint64_t sort_by_cell(const ParticleSet<R>& set, SetRoom<R>& room, const typename RegroupPlan<R>::Moves& moves,
                           const typename RegroupPlan<R>::Sources& sources, std::size_t block) {
  std::array<std::uint32_t, block_nodes + 1> next{};
  next[0] = moves.start[block];
  const auto each_run = [&](const auto& body) {
    for (std::uint32_t s = 0; s < sources.count; ++s) {
      const std::uint32_t old = sources.of[s] / 32, neighbor = sources.of[s] % 32;
      body(old, moves.runs[old][neighbor], moves.runs[old][neighbor + 1]);
    }
  };
  each_run([&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) ++next[(room.order[i] & cell_mask) + 1];
  });
  std::uint64_t cells = 0;
  for (std::size_t c = 0; c < block_nodes; ++c) {
    if (next[c + 1] > 0) cells |= cell_bit_at[c];
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
  RegroupPlan<R> plan;
  std::vector<std::uint64_t> cells;  ///< cells with particles of every new block
  std::vector<SetRoom<R>> sets;
  std::vector<std::vector<std::uint32_t>> taken;  ///< by set, particles that sinks take: they move nowhere
  GridTopology<R> topology;

  void find_moves(World<R>& world);
  void find_places(World<R>& world);
  void move_places(World<R>& world, std::size_t set);
  void move_all(World<R>& world, std::size_t set, bool twice);
};

/// Every old block's particles by the neighbor that they move to.
template <class R>
void Regroup<R>::Scratch::find_moves(World<R>& world) {
  plan.begin(world);
  sets.resize(world.sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) sets[s].prepare(world.sets[s]);
  const auto alike = first_alike(world);
  parallel_for(plan.old_blocks().size(), 16, [&](std::size_t b) {
    std::uint64_t around = 0;
    for (std::size_t s = 0; s < sets.size(); ++s)
      around |= part(world.sets[s], sets[s], plan.moves(s).runs[b], b, alike, taken[s]);
    plan.moves_to(b, around);
  });
}

/// Finds the old place of every particle.
template <class R>
void Regroup<R>::Scratch::find_places(World<R>& world) {
  resize_for_overwrite(cells, plan.sources().size());
  parallel_for(cells.size(), 16, [&](std::size_t b) {
    cells[b] = 0;
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const auto& moves = plan.moves(s);
      if (moves.start[b] < moves.start[b + 1])
        cells[b] |= sort_by_cell(world.sets[s], sets[s], moves, plan.sources()[b], b);
    }
  });
}

/// Positions alone, from block to block.
template <class R>
void Regroup<R>::Scratch::move_places(World<R>& world, std::size_t number) {
  ParticleSet<R>& set = world.sets[number];
  SetRoom<R>& room = sets[number];
  auto& start = plan.moves(number).start;
  const auto seen_there_all = [](R* u, const R* end) {
    for (; u < end; ++u) *u = seen_there(*u);
  };
  for (auto& axis : set.u) permute(axis, room.column, room.from, start.back(), seen_there_all);
  set.block_start.swap(start);
}

/// `twice`: positions alone have been moved before.
template <class R>
void Regroup<R>::Scratch::move_all(World<R>& world, std::size_t number, bool twice) {
  ParticleSet<R>& set = world.sets[number];
  SetRoom<R>& room = sets[number];
  const std::size_t size = plan.moves(number).start.back();
  move_places(world, number);
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
  s.taken.assign(world.sets.size(), {});
  if (sinks_take(world)) s.taken = take_out(world, far);
  const auto sort = [&] { s.find_moves(world), s.plan.find_blocks(world), s.find_places(world); };
  sort();
  if (far) {
    s.taken.assign(world.sets.size(), {});
    for (std::size_t n = 0; n < world.sets.size(); ++n) {
      s.move_places(world, n);
      s.sets[n].before.swap(s.sets[n].from);
    }
    sort();
  }
  for (std::size_t n = 0; n < world.sets.size(); ++n) s.move_all(world, n, far);
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
