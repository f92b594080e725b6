// The particles of some blocks on a device, side by side for the way to the host, and back.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/block_particles.h"

namespace dreampm::gpu {

/// Sets all numbers of an array.
template <class T>
struct Fill {
  static constexpr int threads = 128;
  struct Shared {};
  T* numbers;
  std::int64_t size;
  T value;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    each_item<threads>(block, size, [&](std::int64_t i) { numbers[i] = value; });
  }
};

/// The particles of some blocks. A block of threads takes one of these.
struct NearParticles {
  const std::uint32_t* blocks;
  const std::uint32_t* block_start;
  const std::uint32_t* starts;  ///< where the particles of each begin among them all

  /// Calls body(particle, its number among them all) for thread `t`'s share of block `i`.
  template <int threads, class Body>
  DM_FN void each(int i, int t, const Body& body) const {
    const std::uint32_t block = blocks[i], first = block_start[block], start = starts[i];
    each_particle<threads>(block_start, block, t, [&](std::uint32_t p) { body(p, start + (p - first)); });
  }
};

/// Copies their places side by side.
struct CopyPlaces {
  static constexpr int threads = 128;
  struct Shared {};
  NearParticles near;
  const float* u[3];
  Vec3<float>* to;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      near.each<threads>(block.index(), t,
                         [&](std::uint32_t p, std::uint32_t i) { to[i] = {u[0][p], u[1][p], u[2][p]}; });
    });
  }
};

/// Writes what was measured at these places to columns, as PassInput::distance.
struct SpreadDistances {
  static constexpr int threads = 128;
  struct Shared {};
  NearParticles near;
  const Node<float>* from;
  float* to[4];

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      near.each<threads>(block.index(), t, [&](std::uint32_t p, std::uint32_t i) {
        const Node<float> d = from[i];
        to[0][p] = d.x, to[1][p] = d.y, to[2][p] = d.z, to[3][p] = d.m;
      });
    });
  }
};

}  // namespace dreampm::gpu
