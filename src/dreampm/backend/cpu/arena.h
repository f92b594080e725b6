// Arenas: the part of the grid that the particles of a few blocks reach, copied where a kernel can
// work on it. docs/images/blocks.svg, in ARCHITECTURE.md, is their drawing.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "dreampm/math/scalar.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// The most blocks of particles, consecutive along z, that share an arena. Its nodes are counted
/// from the first node of the grid's block with the number of the first block of particles.
inline constexpr int arena_blocks = 8;
inline constexpr int arena_width = 2 * block_width, arena_depth = block_width * (arena_blocks + 1);
inline constexpr int arena_rows = arena_width * arena_width;

/// The bounds of particles; positions as in ParticleSet::u.
struct Extent {
  Vec3<float> low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  bool known() const { return low.x <= high.x; }
};

/// The rows that the stencils of an arena's particles reach; for spray these are few.
struct ArenaReach {
  int low[2] = {arena_width, arena_width}, high[2] = {-1, -1};  ///< rows along x and y
  bool first = false, last = false;                             ///< the grid's blocks at its two ends along z
};

/// The first node of an arena, or row of nodes, that a particle's stencil reaches along an axis: as
/// make_stencil() finds it, where rounding decides too. `u`: as in ParticleSet::u.
inline int first_node(float u) {
  return static_cast<int>(round_int(min(max(u, -0.99f), block_width + 0.99f) - 0.5f)) + 1;
}

/// The way in which the lanes of a vector gather: together if their stencils begin in two by two
/// rows of the arena. Without ArenaLoops::side_by_side they must also begin at four neighboring
/// nodes along z.
struct LaneGroup {
  bool together;
  bool wide[2];           ///< true if some stencils begin at the second, along x and y
  std::int16_t first[3];  ///< first row along x and y, and first of the four nodes where that counts
};

/// The place of an arena's nodes in the grid.
struct ArenaPlace {
  int blocks;  ///< number of blocks of the grid along z: one more than blocks of particles
  /// The grid's blocks in each of the 2 x 2 pencils along z; BlockList::none where no particle can
  /// come.
  std::int32_t pencil[4][arena_blocks + 1];
  ArenaReach reach;

  /// Calls body(row, block, number of the row's first node in the grid) for every row of nodes
  /// along z in reach of the blocks from `begin` to `end`, as in `pencil`, in the order of the
  /// grid's memory.
  template <class Body>
  DM_FN void for_rows(int begin, int end, const Body& body) const {
    constexpr int w = block_width;
    for (int x = 0; x < 2; ++x)
      for (int y = 0; y < 2; ++y) {
        const int low_i = std::max(reach.low[0], w * x), high_i = std::min(reach.high[0], w * x + w - 1);
        const int low_j = std::max(reach.low[1], w * y), high_j = std::min(reach.high[1], w * y + w - 1);
        if (low_i > high_i || low_j > high_j) continue;
        for (int b = begin; b < end; ++b) {
          const std::int32_t block = pencil[2 * x + y][b];
          if (block == BlockList::none) continue;
          for (int i = low_i; i <= high_i; ++i)
            for (int j = low_j; j <= high_j; ++j)
              body(i * arena_width + j, b, block * block_nodes + first_in_block(i, j));
        }
      }
  }
  /// The pencil through which row (i, j) of the arena runs, and the number within each block of the
  /// row's first node there.
  static constexpr int pencil_of(int i, int j) { return i / block_width * 2 + j / block_width; }
  static constexpr int first_in_block(int i, int j) { return node_index(i % block_width, j % block_width, 0); }
  /// The first block in reach along z, and the one after the last.
  int first() const { return reach.first ? 0 : 1; }
  int end() const { return reach.last ? blocks : blocks - 1; }
};

inline constexpr int node_numbers = 4;  ///< of a Node

/// Splines along z of the rows of one block, from which particles gather. Each row of nodes has
/// three rows of eight numbers, one for each part of a LineSpline, by the spline's middle node. The
/// first part is the nodes' values themselves; in the other two, only the six numbers between the
/// ends are valid. `beside` is the axis, x or y, along which neighboring rows are adjacent in
/// memory.
struct BlockSplines {
  static constexpr int row_floats = 8, parts = 3;
  alignas(64) std::array<float, node_numbers * parts * arena_rows * row_floats + row_floats> v;
  static constexpr int at(int across, int number, int part, int beside) {
    return (((across * node_numbers + number) * parts + part) * arena_width + beside) * row_floats;
  }
  /// Returns the step from a row to the next along x (0) or y.
  static constexpr int step(int axis, int beside) { return axis == beside ? at(0, 0, 0, 1) : at(1, 0, 0, 0); }
};

/// Sums of an arena, to which particles scatter four nodes along z at a time. Groups of four begin
/// at every second node of a row, the first one a node before the row, and each group lies on a
/// cache line of its own. A node is thus in two groups, two places apart, and its sum is that of
/// both. All are zero between passes.
struct ArenaSums {
  static constexpr int row_nodes = 2 * arena_depth;
  static constexpr int block_step = 2 * block_width;  ///< from where a block's row begins to the next block's
  alignas(64) std::array<Node<float>, 4 + arena_rows * row_nodes + 4> room{};
  Node<float>* nodes() { return room.data() + 4; }

  /// The second place of a node within its row; the first lies two before.
  static constexpr int place_of(int node) { return (node + 1) / 2 * 4 + (node + 1) % 2; }
};

/// The loops that move data between grid and arena; `grid`: the nodes of a field.
struct ArenaLoops {
  /// The splines of one of the arena's blocks within its `reach`: of all numbers, of the first
  /// three, or of the first.
  using Fit = void (*)(const Node<float>* grid, const ArenaPlace& place, int block, const ArenaReach& reach, int beside,
                       float* splines);
  Fit fit, fit_three, fit_one;
  /// Adds the arena to the grid and empties it.
  void (*add)(Node<float>* arena, const ArenaPlace& place, Node<float>* grid);
  /// Widens `extent` by `count` positions, a column for each axis, and finds the lane groups of
  /// their vectors. The extent passes over numbers that are NaN.
  void (*measure_extent)(const float* const (&u)[3], std::size_t count, LaneGroup* lane_groups, Extent& extent);
  bool side_by_side;  ///< true if vectors gather from two rows at once if these lie side by side
};

}  // namespace dreampm
