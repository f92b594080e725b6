#include "dreampm/surface/walls.h"

#include <numeric>

namespace dreampm::surface {

Mirrored with_mirror_images(std::span<const Vec3f> points, const Walls& walls, float reach) {
  Mirrored all;
  all.real = points.size();
  all.points.reserve(points.size() + points.size() / 4);
  for (const Vec3f& p : points) all.points.push_back(walls.inside(p));
  all.source.resize(points.size());
  std::iota(all.source.begin(), all.source.end(), 0u);
  all.flipped.assign(points.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t n = all.points.size();
    for (int s = 2 * axis; s < 2 * axis + 2; ++s) {
      if (!walls.closed[static_cast<std::size_t>(s)]) continue;
      for (std::size_t i = 0; i < n; ++i) {
        if (walls.distance(s, all.points[i]) >= reach) continue;
        Vec3f image = all.points[i];
        image[axis] = 2 * walls.place(s) - image[axis];
        all.points.push_back(image);
        all.source.push_back(all.source[i]);
        all.flipped.push_back(static_cast<std::uint8_t>(all.flipped[i] | 1u << axis));
      }
    }
  }
  return all;
}

}  // namespace dreampm::surface
