// The solid mass around the nodes of one block of the grid.
#pragma once
#include "dreampm/backend/common.h"
#include "dreampm/backend/solid_normal.h"

namespace dreampm {

/// The walls behind which solids have images.
template <class R>
SolidImages solid_images(const World<R>& world) {
  SolidImages images;
  for (int side = 0; side < 6; ++side) {
    const int a = side / 2;
    const bool mirrors = world.settings.keep_inside && !world.periodic[static_cast<std::size_t>(a)] &&
                         world.walls[static_cast<std::size_t>(side)].type != WallType::open;
    images.plane[side] = !mirrors ? SolidImages::none : side % 2 == 0 ? world.low[a] : world.high[a];
  }
  return images;
}

/// The solid mass around the nodes of one block, and its images in the walls of the box.
template <class R>
class SolidMass {
 public:
  SolidMass(const World<R>& world, std::size_t block)
      : grid_(world.grid), around_(neighbors_in(world.grid.blocks, world, world.grid.blocks[block])) {
    const SolidImages images = solid_images(world).from(world.grid.blocks[block] * block_width);
    // Nodes share most of those around them. Few are so near to a wall that they have images.
    bool beside_z[width];
    bool any_z = false;
    for (int k = 0; k < width; ++k) any_z |= beside_z[k] = images.any_at(2, k - 1);
    const auto own = [this](const Vec3i& at) { return own_mass(at); };
    R* to = masses_.mass;
    for (int i = -1; i < width - 1; ++i)
      for (int j = -1; j < width - 1; ++j, to += width) {
        find_row(i, j, to);
        const bool all = images.any_at(0, i) || images.any_at(1, j);
        for (int k = 0; (all || any_z) && k < width; ++k)
          if (all || beside_z[k]) to[k] = images.mass({i, j, k - 1}, own);
      }
  }

  /// As SolidMasses.
  Vec3<R> normal_at(int n) const { return masses_.normal_at(n); }

 private:
  static constexpr int width = SolidMasses<R>::width;

  /// Along z from the node before the block to the one behind it.
  void find_row(int i, int j, R* to) const {
    const std::int32_t* const blocks = around_.data() + (((i + 4) / 4) * 3 + (j + 4) / 4) * 3;
    const auto node = [&](int side, int k) {
      return blocks[side] == BlockList::none ? R(0)
                                             : grid_
                                                   .solids[static_cast<std::size_t>(blocks[side]) * block_nodes +
                                                           static_cast<std::size_t>(node_index(i & 3, j & 3, k))]
                                                   .m;
    };
    to[0] = node(0, block_width - 1);
    for (int k = 0; k < block_width; ++k) to[k + 1] = node(1, k);
    to[width - 1] = node(2, 0);
  }
  R own_mass(const Vec3i& at) const {
    const std::int32_t block = around_[static_cast<std::size_t>(block_around(at))];
    if (block == BlockList::none) return R(0);
    const std::size_t first = static_cast<std::size_t>(block) * block_nodes;
    return grid_.solids[first + static_cast<std::size_t>(node_index(at.x & 3, at.y & 3, at.z & 3))].m;
  }

  const GridFields<R>& grid_;
  Neighbors around_;
  SolidMasses<R> masses_;
};

}  // namespace dreampm
