// The gaps between solids or grains and walls or colliders on a device, as ContactGaps. They are
// kept as the bits of floats, which order like whole numbers where they are not negative: so a
// minimum of many threads has no order.
#pragma once
#include <bit>
#include <cstdint>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/block_particles.h"
#include "dreampm/backend/node_terms.h"
#include "dreampm/backend/pass_limits.h"
#include "dreampm/backend/wall_distance.h"

namespace dreampm::gpu {

/// Numbers of one block's gaps: its nodes by side.
inline constexpr int block_gaps = 6 * block_nodes;

/// Sets all gaps of a block to those where no matter is near.
struct ClearGaps {
  static constexpr int threads = 128;
  struct Shared {};
  std::int32_t* gaps;
  float none;  ///< cells

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      for (int n = t; n < block_gaps; n += threads)
        gaps[std::int64_t{block.index()} * block_gaps + n] = std::bit_cast<std::int32_t>(none);
    });
  }
};

/// A block of particles near walls, as ContactGaps::NearBlock.
struct NearWalls {
  std::uint32_t block;
  std::int8_t plane[6];
};

/// The gaps of a set's particles: each lowers that of the node at which its stencil begins.
struct GapInput {
  const float* u[3];
  const std::uint32_t* block_start;
  const std::int32_t* stencil_blocks;  ///< eight a block of particles
  const std::int32_t* gaps_of;         ///< by block of the grid: a number of gaps, or -1
  std::int32_t* gaps;
  float taken;  ///< cells, by half a particle

  DM_FN Vec3<float> place(std::uint32_t p) const { return {u[0][p], u[1][p], u[2][p]}; }
  /// Lowers the gap of a node, counted from the first that the block reaches, before a face that is
  /// turned like that side; the particle is `away` from it [cells].
  template <class Block>
  DM_FN void lower(std::uint32_t block, int side, const Vec3i& node, float away) const {
    const int corner = (node.x / block_width * 2 + node.y / block_width) * 2 + node.z / block_width;
    const std::int32_t holder = stencil_blocks[8 * block + static_cast<std::uint32_t>(corner)];
    const std::int32_t slot = holder < 0 ? -1 : gaps_of[holder];
    if (slot < 0) return;
    const int n = node_index(node.x % block_width, node.y % block_width, node.z % block_width);
    Block::lower(gaps[std::int64_t{slot} * block_gaps + side * block_nodes + n],
                 std::bit_cast<std::int32_t>(max(0.0f, away - taken)));
  }
};

/// The gaps before the walls of the box.
struct MeasureGaps {
  static constexpr int threads = 128;
  struct Shared {};
  GapInput in;
  const NearWalls* near;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const NearWalls at = near[block.index()];
    block.each_thread([&](int t) {
      each_particle<threads>(in.block_start, at.block, t, [&](std::uint32_t p) {
        for (int side = 0; side < 6; ++side)
          if (at.plane[side] >= 0) measure<Block>(at, side, in.place(p));
      });
    });
  }

 private:
  template <class Block>
  DM_FN void measure(const NearWalls& at, int side, const Vec3<float>& u) const {
    const int a = axis_of(side);
    const float away = WallDistance<float>(int{at.plane[side]}, side).of(u[a]);
    if (!(away < static_cast<float>(kernel_reach))) return;
    Vec3i node;
    for (int b = 0; b < 3; ++b) node[b] = b == a ? int{at.plane[side]} : first_node(u[b]);
    in.lower<Block>(at.block, side, node, away);
  }
};

/// The gaps before colliders, by the mean of their distance over a particle's stencil, or by its
/// own from thin ones.
struct MeasureColliderGaps {
  static constexpr int threads = 128;
  struct Shared {};
  GapInput in;
  const std::uint32_t* near;     ///< blocks of particles
  const Node<float>* clearance;  ///< by node of the grid: the gradient of the distance, and that [cells]
  const float* distance[4];      ///< as PassInput

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const std::uint32_t b = near[block.index()];
    block.each_thread([&](int t) {
      each_particle<threads>(in.block_start, b, t, [&](std::uint32_t p) {
        const Vec3<float> u = in.place(p);
        const Node<float> away = distance[0] && distance[3][p] < no_distance
                                     ? Node<float>{distance[0][p], distance[1][p], distance[2][p], distance[3][p]}
                                     : clearance_at(b, make_stencil(u));
        if (!(away.m < static_cast<float>(kernel_reach))) return;
        in.lower<Block>(b, side_like(Vec3<float>{away.x, away.y, away.z}),
                        {first_node(u.x), first_node(u.y), first_node(u.z)}, away.m);
      });
    });
  }

 private:
  DM_FN Node<float> clearance_at(std::uint32_t b, const Stencil<float>& stencil) const {
    Node<float> mean{0, 0, 0, 0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          mean = mul_add(clearance[node_in_reach(in.stencil_blocks + 8 * b, stencil, i, j, k)], stencil.weight(i, j, k),
                         mean);
    return mean;
  }
};

/// The nodes of one block of the grid on a wall or behind it, as ContactGaps::WallNodes.
struct WallPlane {
  std::int32_t from[4];  ///< numbers of gaps of the blocks with the wall: itself, those before it along both axes
  std::int32_t side, plane;
};

/// The gap of each node on walls: the least of the stencils that begin at it or at one of the two
/// nodes before it along each axis. A block of threads takes four planes.
struct FindWallGaps {
  static constexpr int threads = 64, at_once = threads / plane_nodes;
  struct Shared {};
  const WallPlane* walls;
  std::int32_t count;
  const std::int32_t* gaps;
  float none;  ///< cells
  float* gap;  ///< plane_nodes a wall

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const int w = block.index() * at_once + t / plane_nodes, n = t % plane_nodes;
      if (w >= count) return;
      const WallPlane& wall = walls[w];
      const int a = axis_of(wall.side), b = (a + 1) % 3, c = (a + 2) % 3;
      float least = none;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int row = n / block_width - i, column = n % block_width - j;
          const std::int32_t slot = wall.from[(row < 0) * 2 + (column < 0)];
          if (slot < 0) continue;
          Vec3i node;
          node[a] = wall.plane, node[b] = row & (block_width - 1), node[c] = column & (block_width - 1);
          least = min(
              std::bit_cast<float>(
                  gaps[std::int64_t{slot} * block_gaps + wall.side * block_nodes + node_index(node.x, node.y, node.z)]),
              least);
        }
      gap[std::int64_t{w} * plane_nodes + n] = least;
    });
  }
};

}  // namespace dreampm::gpu
