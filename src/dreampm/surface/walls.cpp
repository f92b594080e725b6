#include "dreampm/surface/walls.h"

namespace dreampm::surface {

std::vector<Vec3f> with_mirror_images(std::span<const Vec3f> points, const Walls& walls, float reach) {
  std::vector<Vec3f> all;
  all.reserve(points.size() + points.size() / 4);
  for (const Vec3f& p : points) all.push_back(walls.inside(p));
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t n = all.size();
    for (int s = 2 * axis; s < 2 * axis + 2; ++s) {
      if (!walls.closed[static_cast<std::size_t>(s)]) continue;
      for (std::size_t i = 0; i < n; ++i) {
        if (walls.distance(s, all[i]) >= reach) continue;
        Vec3f image = all[i];
        image[axis] = 2 * walls.place(s) - image[axis];
        all.push_back(image);
      }
    }
  }
  return all;
}

}  // namespace dreampm::surface
