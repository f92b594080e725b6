// The surface of a solid, found from the masses of nodes. Compilers of device code read it too.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"
#include "dreampm/state/node.h"

namespace dreampm {

/// The planes of nodes of the walls of the box behind which solids have images, by side: without
/// these a normal beside a wall would lean on it, and liquid would leak along the wall past a solid
/// that fills the box.
struct SolidImages {
  static constexpr std::int32_t none = 1 << 28;  ///< the plane of a side without
  std::int32_t plane[6];

  /// Counted from the node `first` on.
  DM_FN SolidImages from(const Vec3i& first) const {
    SolidImages images = *this;
    for (int side = 0; side < 6; ++side) images.plane[side] -= first[side / 2];
    return images;
  }
  /// True if nodes at that place along an axis have images in matter that lies before the wall.
  DM_FN bool any_at(int axis, int at) const { return beside(2 * axis, at) || beside(2 * axis + 1, at); }
  /// The mass at a node and of its images across the axes from `axis` on. `own(node)`: that of a
  /// node alone.
  template <int axis = 0, class Own>
  DM_FN auto mass(const Vec3i& at, const Own& own) const {
    if constexpr (axis == 3) {
      return own(at);
    } else {
      auto sum = mass<axis + 1>(at, own);
      for (int side = 2 * axis; side < 2 * axis + 2; ++side) {
        if (!beside(side, at[axis])) continue;
        Vec3i image = at;
        image[axis] = 2 * plane[side] - at[axis];
        sum += mass<axis + 1>(image, own);
      }
      return sum;
    }
  }

 private:
  DM_FN bool beside(int side, int at) const { return at - plane[side] <= 1 && plane[side] - at <= 1; }
};

/// The number among the 27 blocks around a block of the one with that node, which counts from the
/// block's first and is at most a block away.
DM_FN int block_around(const Vec3i& at) {
  return ((at.x + block_width) / block_width * 3 + (at.y + block_width) / block_width) * 3 +
         (at.z + block_width) / block_width;
}

/// The solid mass at the nodes of a block and at those beside them [kg], z fastest.
template <class R>
struct SolidMasses {
  static constexpr int width = block_width + 2, count = width * width * width;
  R mass[count];

  /// The place of number `i`, counted from the block's first node.
  static DM_FN Vec3i place(int i) { return {i / (width * width) - 1, i / width % width - 1, i % width - 1}; }
  /// The unit normal out of the solid at node `n` of the block: down the gradient of its mass over
  /// the 27 nodes around, the differences smoothed across by 1 2 1; zero where the mass has no
  /// clear slope.
  DM_FN Vec3<R> normal_at(int n) const {
    const int i = n / 16, j = n / 4 % 4, k = n % 4;
    Vec3<R> uphill{R(0), R(0), R(0)};
    R sum(0);
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) {
          const R m = mass[((i + x) * width + j + y) * width + k + z];
          uphill += Vec3<R>{R((x - 1) * smooth(y) * smooth(z)), R((y - 1) * smooth(z) * smooth(x)),
                            R((z - 1) * smooth(x) * smooth(y))} *
                    m;
          sum += m * R(smooth(x) * smooth(y) * smooth(z));
        }
    const R steep = sqrt(dot(uphill, uphill));
    return steep > R(1e-3) * sum ? uphill * (R(-1) / steep) : Vec3<R>{R(0), R(0), R(0)};
  }

 private:
  static DM_FN int smooth(int i) { return i == 1 ? 2 : 1; }
};

}  // namespace dreampm
