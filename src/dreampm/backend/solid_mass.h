// The surface of a solid, found from the mass of its nodes.
#pragma once
#include <array>
#include <cstdlib>

#include "dreampm/backend/common.h"

namespace dreampm {

/// The solid mass around the nodes of one block, and its images in the walls of the box: without
/// them a normal beside a wall would lean on it, and liquid would leak along the wall past a solid
/// that fills the box.
template <class R>
class SolidMass {
 public:
  SolidMass(const World<R>& world, std::size_t block)
      : grid_(world.grid), around_(neighbors_in(world.grid.blocks, world, world.grid.blocks[block])) {
    const Vec3i first = world.grid.blocks[block] * block_width;
    for (int side = 0; side < 6; ++side) {
      const int a = side / 2;
      const bool mirrors = world.settings.keep_inside && !world.periodic[static_cast<std::size_t>(a)] &&
                           world.walls[static_cast<std::size_t>(side)].type != WallType::open;
      plane_[side] = mirrors ? (side % 2 == 0 ? world.low[a] : world.high[a]) - first[a] : far;
    }
    // Nodes share most of those around them. Few are so near to a wall that they have images.
    const auto has_images = [this](int axis, int at) {
      return std::abs(at - plane_[2 * axis]) <= 1 || std::abs(at - plane_[2 * axis + 1]) <= 1;
    };
    bool beside_z[width];
    bool any_z = false;
    for (int k = 0; k < width; ++k) any_z |= beside_z[k] = has_images(2, k - 1);
    R* to = masses_.data();
    for (int i = -1; i < width - 1; ++i)
      for (int j = -1; j < width - 1; ++j, to += width) {
        find_row(i, j, to);
        const bool all = has_images(0, i) || has_images(1, j);
        for (int k = 0; (all || any_z) && k < width; ++k)
          if (all || beside_z[k]) to[k] = mass({i, j, k - 1});
      }
  }

  /// The unit normal out of the solid: down the gradient of its mass over the 27 nodes around, the
  /// differences smoothed across by 1 2 1; zero where the mass has no clear slope.
  Vec3<R> normal_at(int n) const {
    const int i = n / 16, j = n / 4 % 4, k = n % 4;
    constexpr int smooth[3] = {1, 2, 1};
    Vec3<R> uphill{};
    R sum(0);
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) {
          const R m = masses_[static_cast<std::size_t>(((i + x) * width + j + y) * width + k + z)];
          uphill += Vec3<R>{R((x - 1) * smooth[y] * smooth[z]), R((y - 1) * smooth[z] * smooth[x]),
                            R((z - 1) * smooth[x] * smooth[y])} *
                    m;
          sum += m * R(smooth[x] * smooth[y] * smooth[z]);
        }
    const R steep = length(uphill);
    return steep > R(1e-3) * sum ? uphill * (R(-1) / steep) : Vec3<R>{};
  }

 private:
  static constexpr int far = 1 << 20;
  static constexpr int width = block_width + 2;

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
  /// Returns the mass at a node of the block or next to it, with the images across the axes from
  /// `axis` on.
  R mass(const Vec3i& at, int axis = 0) const {
    if (axis == 3) return own_mass(at.x, at.y, at.z);
    R sum = mass(at, axis + 1);
    for (const int plane : {plane_[2 * axis], plane_[2 * axis + 1]}) {
      if (std::abs(at[axis] - plane) > 1) continue;
      Vec3i image = at;
      image[axis] = 2 * plane - at[axis];
      sum += mass(image, axis + 1);
    }
    return sum;
  }
  R own_mass(int i, int j, int k) const {
    const int side = (((i + 4) / 4) * 3 + (j + 4) / 4) * 3 + (k + 4) / 4;
    const std::int32_t block = around_[static_cast<std::size_t>(side)];
    if (block == BlockList::none) return R(0);
    const std::size_t first = static_cast<std::size_t>(block) * block_nodes;
    return grid_.solids[first + static_cast<std::size_t>(node_index(i & 3, j & 3, k & 3))].m;
  }

  const GridFields<R>& grid_;
  Neighbors around_;
  int plane_[6];                                 ///< of the walls, in nodes of the block
  std::array<R, width * width * width> masses_;  ///< at its nodes and those beside them, z fastest
};

}  // namespace dreampm
