// Blocks of particles and the cells around them.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/math/four.h"
#include "dreampm/solver/projection/cell_rows.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The window of a block of particles: the columns of cells around it in the arrays of a grid. It
/// holds the cells that its particles reach, and `reach` cells more to each side.
template <int reach>
class Window {
 public:
  static constexpr int width = block_width + 2 + 2 * reach;

  Window(const CellRows& cells, const Vec3i& block) : first_(first_stencil(block) - Vec3i{reach, reach, reach}) {
    // Rows are there wherever particles reach, and so are those before a row that they reach.
    const std::int32_t z = block.z * block_width & ~(row_cells - 1);
    const auto before = static_cast<std::size_t>(z - first_.z);
    const Vec3i last = first_ + Vec3i{width - 1, width - 1, 0};
    cells.for_tiles_around({first_.x, first_.y, z}, width, [&](int x, int y, const CellRows::Tile* tile) {
      for (int i = std::max(first_.x, x); i <= std::min(last.x, x + block_width - 1); ++i)
        for (int j = std::max(first_.y, y); j <= std::min(last.y, y + block_width - 1); ++j)
          columns_[(i - first_.x) * width + j - first_.y] = tile ? tile->place_before(i - x, j - y, before) : 0;
    });
  }
  /// The cell that places count from.
  const Vec3i& first() const { return first_; }
  /// The place of the first cell of each column, by (i, j).
  const std::size_t* columns() const { return columns_; }
  std::size_t place(int i, int j, int k) const { return columns_[i * width + j] + static_cast<std::size_t>(k); }

 private:
  Vec3i first_;
  std::size_t columns_[width * width];
};

/// Loads the motion of a particle along an axis, as given_to_faces() takes it.
template <class R>
DM_FN void motion_along(const ParticleSet<R>& set, std::size_t p, std::size_t axis, R dx, Four<R>& motion) {
  motion = Four<R>{set.own_velocity[axis][p], set.gradient[3 * axis][p] * dx, set.gradient[3 * axis + 1][p] * dx,
                   set.gradient[3 * axis + 2][p] * dx};
}

/// Calls body(b) for all blocks of particles, those of one color side by side.
template <class R, class Body>
void for_blocks_by_color(const World<R>& world, const Body& body) {
  // Blocks of one color do not reach the same cells.
  const std::vector<Vec3i>& blocks = world.particle_blocks;
  for (int color = 0; color < 8; ++color)
    parallel_for(blocks.size(), 32, [&](std::size_t b) {
      if ((blocks[b].x & 1) * 4 + (blocks[b].y & 1) * 2 + (blocks[b].z & 1) == color) body(b);
    });
}

}  // namespace dreampm
