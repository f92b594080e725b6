// Matter that comes in on a device.
#pragma once
#include <cstddef>
#include <cstdint>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/block_particles.h"
#include "dreampm/backend/gpu/sort_kernels.h"
#include "dreampm/state/particle_move.h"

namespace dreampm::gpu {

/// Moves the particles of every block to where it begins now, in their order: between them is room
/// for new ones.
struct OpenColumns {
  static constexpr int threads = 128;
  struct Shared {};
  const std::uint32_t *before, *after;  ///< by block of particles: where it begins; `before`: and the end
  MovedColumns set;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const auto b = static_cast<std::uint32_t>(block.index());
    block.each_thread([&](int t) {
      each_particle<threads>(
          before, b, t, [&](std::uint32_t p) { set.move(p, after[b] + (p - before[b]), [](float u) { return u; }); });
    });
  }
};

/// A new particle.
struct PlacedSeed {
  std::uint32_t number;  ///< in its set
  std::uint32_t id;
  float u[3], own_velocity[3];
};

/// As many go to a device at once.
inline constexpr std::size_t seeds_at_once = 1 << 15;

/// Writes new particles at rest state to their places.
struct PlaceSeeds {
  static constexpr int threads = 128;
  struct Shared {};
  const PlacedSeed* seeds;
  std::uint32_t count, columns;  ///< of seeds, and of state
  float rest[most_state_columns];
  ParticleColumns out;
  std::uint32_t* id;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const std::uint32_t i = static_cast<std::uint32_t>(block.index()) * threads + static_cast<std::uint32_t>(t);
      if (i >= count) return;
      const PlacedSeed seed = seeds[i];
      id[seed.number] = seed.id;
      for (int a = 0; a < 3; ++a) {
        out.u[a][seed.number] = seed.u[a];
        if (out.own_velocity[a]) out.own_velocity[a][seed.number] = seed.own_velocity[a];
      }
      for (std::uint32_t c = 0; c < columns; ++c) out.state[c][seed.number] = rest[c];
    });
  }
};

/// The cells of sorted particles of a set, by block.
struct HoldCells {
  static constexpr int threads = 128;
  struct Shared {
    std::int32_t counts[block_nodes];
  };
  const float* u[3];
  const std::uint32_t* block_start;  ///< by block of particles, and the end
  std::uint32_t* cells;              ///< two a block, as StartCells::cells
  bool first;                        ///< else those of other sets are there already

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      if (t < block_nodes) shared.counts[t] = 0;
    });
    block.each_thread([&](int t) {
      each_particle<threads>(block_start, static_cast<std::uint32_t>(b), t, [&](std::uint32_t p) {
        Block::add(shared.counts[held_cell(Vec3<float>{u[0][p], u[1][p], u[2][p]})], 1);
      });
    });
    block.each_thread([&](int t) {
      if (t > 1) return;
      std::uint32_t any = 0;
      for (int c = 0; c < block_nodes; ++c)
        if (shared.counts[c] > 0 && c / 32 == t) any |= 1u << c % 32;
      cells[2 * b + t] = first ? any : cells[2 * b + t] | any;
    });
  }
};

/// Finds the blocks of a field whose nodes are all zero.
struct FindEmptyBlocks {
  static constexpr int threads = block_nodes;
  struct Shared {
    std::int32_t filled;
  };
  const Node<float>* field;
  std::int32_t* filled;  ///< by block: how many of its nodes are not zero

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      if (t == 0) shared.filled = 0;
    });
    block.each_thread([&](int t) {
      const Node<float> n = field[std::int64_t{b} * block_nodes + t];
      if (!(n.x == 0 && n.y == 0 && n.z == 0 && n.m == 0)) Block::add(shared.filled, 1);
    });
    block.each_thread([&](int t) {
      if (t == 0) filled[b] = shared.filled;
    });
  }
};

}  // namespace dreampm::gpu
