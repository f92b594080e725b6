// Stage 0: flat walls that the liquid wets.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::surface {

/// Closed sides of a box. Side 2 a is the lower wall of axis a, side 2 a + 1 the upper one.
struct Walls {
  Box3f box;
  std::array<bool, 6> closed{};

  float place(int side) const { return side % 2 == 0 ? box.min[side / 2] : box.max[side / 2]; }
  /// Distance to wall `side`, positive on the liquid's side.
  float distance(int side, const Vec3f& p) const {
    const float d = p[side / 2] - place(side);
    return side % 2 == 0 ? d : -d;
  }
  /// Smallest distance to any closed wall; large if there is none.
  float distance(const Vec3f& p) const {
    float d = 1e30f;
    for (int s = 0; s < 6; ++s)
      if (closed[static_cast<std::size_t>(s)]) d = std::min(d, distance(s, p));
    return d;
  }
  /// p moved onto the wall where it lies beyond.
  Vec3f inside(Vec3f p) const {
    for (int s = 0; s < 6; ++s)
      if (closed[static_cast<std::size_t>(s)] && distance(s, p) < 0) p[s / 2] = place(s);
    return p;
  }
};

/// Points and, after them, their mirror images.
struct Mirrored {
  std::vector<Vec3f> points;
  std::size_t real = 0;               ///< the first `real` are no images
  std::vector<std::uint32_t> source;  ///< the real point that each is an image of, itself included
  std::vector<std::uint8_t> flipped;  ///< bit a: mirrored along axis a
};

/// All points, moved inside, and images of those nearer than `reach` to a wall (images of images in
/// the box's edges and corners too), so that a wall looks like the middle of the liquid.
Mirrored with_mirror_images(std::span<const Vec3f> points, const Walls& walls, float reach);

}  // namespace dreampm::surface
