// Sorting particles into blocks and cells on a device: state/particle_move.h says where each goes,
// state/regroup_plan.h which blocks there are. Threads may come in any order, and so may the
// particles of a cell at first; they are put in the order in which they were before.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/block_particles.h"
#include "dreampm/backend/gpu/pass.h"
#include "dreampm/state/particle_move.h"

namespace dreampm::gpu {

/// The particles of a set before a sort.
struct SortInput {
  const float* u[3];
  const std::uint32_t* block_start;  ///< by block of particles, and the end
  /// Numbers of particles that sinks take, rising, and where those of each block begin there, and
  /// the end; null where they take none.
  const std::uint32_t *taken, *taken_start;
  std::uint8_t alike[28];  ///< as Alike
  static constexpr int neighbors = 27;

  DM_FN Vec3<float> place(std::uint32_t p) const { return {u[0][p], u[1][p], u[2][p]}; }
  /// Where particle `p` of block `b` goes, which is at `at`: the neighbor, or `neighbors` where it
  /// leaves the world.
  DM_FN int way(int b, std::uint32_t p, const Vec3<float>& at) const {
    return taken && is_taken(b, p) ? neighbors : alike[neighbor_of(at)];
  }

 private:
  DM_FN bool is_taken(int b, std::uint32_t p) const {
    const std::uint32_t end = taken_start[b + 1];
    std::uint32_t low = taken_start[b], high = end;
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (taken[middle] < p)
        low = middle + 1;
      else
        high = middle;
    }
    return low < end && taken[low] == p;
  }
};

/// Counts the particles of each block that move to each of the 27 around it.
struct CountMoves {
  static constexpr int threads = 128;
  struct Shared {
    std::int32_t counts[SortInput::neighbors];
  };
  SortInput in;
  std::int32_t* counts;  ///< 27 a block

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      if (t < SortInput::neighbors) shared.counts[t] = 0;
    });
    block.each_thread([&](int t) {
      each_particle<threads>(in.block_start, static_cast<std::uint32_t>(b), t, [&](std::uint32_t p) {
        const int way = in.way(b, p, in.place(p));
        if (way < SortInput::neighbors) Block::add(shared.counts[way], 1);
      });
    });
    block.each_thread([&](int t) {
      if (t < SortInput::neighbors) counts[std::int64_t{b} * SortInput::neighbors + t] = shared.counts[t];
    });
  }
};

/// Where particles go: the new block by old block and neighbor, 27 a block; -1 of those that leave.
struct SortTargets {
  const std::int32_t* block;

  /// Calls body(particle, cell) for thread `t`'s share of the particles of an old block that stay
  /// in the world. `cell`: its number among those of all new blocks, in their order.
  template <int threads, class Body>
  DM_FN void each(const SortInput& in, int old_block, int t, const Body& body) const {
    each_particle<threads>(in.block_start, static_cast<std::uint32_t>(old_block), t, [&](std::uint32_t p) {
      const Vec3<float> at = in.place(p);
      const int way = in.way(old_block, p, at);
      if (way == SortInput::neighbors) return;
      const std::int32_t to = block[std::int64_t{old_block} * SortInput::neighbors + way];
      if (to >= 0) body(p, std::int64_t{to} * block_nodes + turn_of(at));
    });
  }
};

/// Counts the particles of each cell of the new blocks, and gives each a number in its cell.
struct CountCells {
  static constexpr int threads = 128;
  struct Shared {};
  SortInput in;
  SortTargets targets;
  std::int32_t* counts;  ///< by cell, from 0
  std::int32_t* number;  ///< by particle

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      targets.each<threads>(in, block.index(), t,
                            [&](std::uint32_t p, std::int64_t cell) { number[p] = Block::count(counts[cell]); });
    });
  }
};

/// The place where the particles of each cell begin, and which cells have any.
struct StartCells {
  static constexpr int threads = block_nodes;
  struct Shared {
    std::int32_t counts[threads];
  };
  const std::int32_t* counts;        ///< by cell
  const std::uint32_t* block_start;  ///< of the new blocks
  std::uint32_t* start;              ///< by cell
  std::uint32_t* cells;              ///< two a block: a bit for each cell with particles, by node_index()
  bool first;                        ///< else those of other sets are there already

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) { shared.counts[t] = counts[std::int64_t{b} * block_nodes + t]; });
    block.each_thread([&](int t) {
      std::uint32_t at = block_start[b];
      for (int c = 0; c < t; ++c) at += static_cast<std::uint32_t>(shared.counts[c]);
      start[std::int64_t{b} * block_nodes + t] = at;
      if (t > 1) return;
      std::uint32_t any = 0;
      for (int c = 0; c < block_nodes; ++c)
        if (const int cell = cell_at(c); shared.counts[c] > 0 && cell / 32 == t) any |= 1u << cell % 32;
      cells[2 * b + t] = first ? any : cells[2 * b + t] | any;
    });
  }
};

/// The former place of each particle, those of a cell in any order.
struct FillPlaces {
  static constexpr int threads = 128;
  struct Shared {};
  SortInput in;
  SortTargets targets;
  const std::uint32_t* start;  ///< by cell
  const std::int32_t* number;  ///< by particle
  std::uint32_t* from;         ///< by new place

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      targets.each<threads>(in, block.index(), t, [&](std::uint32_t p, std::int64_t cell) {
        from[start[cell] + static_cast<std::uint32_t>(number[p])] = p;
      });
    });
  }
};

/// Puts the former places of each cell's particles in order.
struct SortPlaces {
  static constexpr int threads = block_nodes;
  struct Shared {};
  const std::uint32_t* start;        ///< by cell
  const std::uint32_t* block_start;  ///< of the new blocks
  std::uint32_t* from;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      const std::int64_t cell = std::int64_t{b} * block_nodes + t;
      sort(from + start[cell], (t + 1 < block_nodes ? start[cell + 1] : block_start[b + 1]) - start[cell]);
    });
  }

 private:
  /// Shell 1959 (Commun. ACM 2:30), with the gaps of Ciura 2001: a cell has a few particles, and a
  /// crowded one is no disaster.
  static DM_FN void sort(std::uint32_t* of, std::uint32_t count) {
    constexpr std::uint32_t gaps[] = {701, 301, 132, 57, 23, 10, 4, 1};
    for (const std::uint32_t gap : gaps)
      for (std::uint32_t i = gap; i < count; ++i) {
        const std::uint32_t one = of[i];
        std::uint32_t to = i;
        for (; to >= gap && of[to - gap] > one; to -= gap) of[to] = of[to - gap];
        of[to] = one;
      }
  }
};

/// All columns of a set, on their way to new places.
struct MovedColumns {
  std::uint32_t columns;  ///< of state
  ParticleColumns in, out;
  const std::uint32_t* id_in;
  std::uint32_t* id_out;

  /// `place`: what becomes of a coordinate.
  template <class Place>
  DM_FN void move(std::uint32_t p, std::uint32_t to, const Place& place) const {
    id_out[to] = id_in[p];
    for (int a = 0; a < 3; ++a) {
      out.u[a][to] = place(in.u[a][p]);
      if (in.own_velocity[a]) out.own_velocity[a][to] = in.own_velocity[a][p];
    }
    for (std::uint32_t c = 0; c < columns; ++c) out.state[c][to] = in.state[c][p];
  }
};

/// Brings the particles of a set to their new places.
struct MoveParticles {
  static constexpr int threads = 128;
  struct Shared {};
  const std::uint32_t* from;
  std::uint32_t size;  ///< particles
  MovedColumns set;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    each_item<threads>(block, size, [&](std::int64_t to) {
      set.move(from[to], static_cast<std::uint32_t>(to), [](float u) { return seen_there(u); });
    });
  }
};

/// Brings the nodes of a field to the new places of their blocks; those of new blocks are zero.
struct CarryNodes {
  static constexpr int threads = block_nodes;
  struct Shared {};
  const std::int32_t* before;  ///< by new block: its number before, or -1
  const Node<float>* from;     ///< null where the field is new
  Node<float>* to;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const std::int32_t old = before[block.index()];
    block.each_thread([&](int t) {
      to[std::int64_t{block.index()} * block_nodes + t] =
          from && old >= 0 ? from[std::int64_t{old} * block_nodes + t] : Node<float>{};
    });
  }
};

}  // namespace dreampm::gpu
